// A small baked model as `prt compress` would write it, of made-up transfer: a ball over a floor, and a lamp; its transfer in
// vertices or in texels.
import { PlaneGeometry, SphereGeometry } from "three";
import { encodedRows } from "./encodedRows.js";
import { Binary, png } from "./glb.js";
import { transferOf } from "./transferSets.js";

export const PARTS = [
  { kind: "direct", channels: 1 },
  { kind: "indirect", channels: 3 },
  { kind: "lamp", channels: 1, name: "Lantern" },
];
const ORDER = 2;
export const COMPONENTS = [4, 2, 3];
export const WIDTHS = [[8, 7, 9, 8], [5, 16], [8, 3, 12]];
const CLUSTER_BITS = 4;
const SIZE = 4 + 3 * 4 + 1;
const WORDS = 2;

/** Returns a generator of pseudo-random numbers, equal in every run. */
function random(seed) {
  let state = seed;
  return () => (state = (state * 1664525 + 1013904223) % 2 ** 32) / 2 ** 32;
}

/**
 * Returns bases without predictors, or with predictors from the normal: bright means, and directions of about
 * a fifth of the mean.
 */
function bases(predictors) {
  const next = random(7);
  const row = (most, mean) =>
    Array.from({ length: SIZE }, (_, a) => (mean && [0, 4, 8, 12].includes(a) ? 0.25 : 0) + most * (next() - 0.5));
  return COMPONENTS.flatMap((m) => [...row(0.05, true), ...Array.from({ length: predictors + m }, () => row(0.08, false)).flat()]);
}

/** Returns the words at (u, v) of object `i`: its cluster, and smoothly varying weights. */
export function wordsAt(u, v, i) {
  const cluster = (i + Math.floor(2.999 * u)) % COMPONENTS.length;
  let bits = BigInt(cluster);
  let at = CLUSTER_BITS;
  WIDTHS[cluster].forEach((width, j) => {
    const share = 0.5 + 0.5 * Math.sin((j + 1) * 3 * u + (5 - j) * v + i);
    bits |= BigInt(Math.round(share * (2 ** width - 1))) << BigInt(at);
    at += width;
  });
  return [Number(bits & 0xffffffffn), Number(bits >> 32n)];
}

/** Widths minus one, four bits each. */
function packedWidths() {
  const codes = WIDTHS.flat().map((width) => width - 1);
  return Uint8Array.from({ length: Math.ceil(codes.length / 2) }, (_, i) => codes[2 * i] | ((codes[2 * i + 1] ?? 0) << 4));
}

const clusters = (binary, predictors) => ({
  coding: "clustered",
  order: ORDER,
  terms: PARTS,
  components: COMPONENTS,
  bases: { bufferView: binary.view(new Float32Array(bases(predictors))), componentType: 5126 },
  packing: { clusterBits: CLUSTER_BITS, bufferView: binary.view(packedWidths()) },
});

/** Returns texels with the words `of(x, y)`: one image per word. */
function images(binary, width, height, of) {
  const words = Array.from({ length: WORDS }, () => new Uint32Array(width * height));
  for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) of(x, y).forEach((word, j) => (words[j][y * width + x] = word));
  return words.map((list) => ({ bufferView: binary.view(png(width, height, list)), mimeType: "image/png" }));
}

export const MAPS = [
  { width: 96, height: 64, repeats: false },
  { width: 40, height: 56, repeats: true },
];
/**
 * Returns the words of a texel: the first rows are random, with all values of bytes, including alpha; the
 * others follow the surface.
 */
export function texelWords(i, x, y) {
  if (y >= 8) return wordsAt((x + 0.5) / MAPS[i].width, (y + 0.5) / MAPS[i].height, i);
  const next = random(1000 * i + 100 * y + x + 1);
  for (let skipped = 0; skipped < 4; ++skipped) next();
  const word = () => Math.floor(next() * 2 ** 32) & (x % 3 === 0 ? 0x00ffffff : 0xffffffff);
  return [((word() & ~15) | (x % 3)) >>> 0, word() >>> 0]; // in one of the clusters
}

function normalMap() {
  const bytes = new Uint8Array(4 * 64 * 64);
  for (let y = 0; y < 64; ++y)
    for (let x = 0; x < 64; ++x)
      bytes.set([128 + 40 * Math.sin(x / 5), 128 + 40 * Math.cos(y / 4), 250, 255], 4 * (64 * y + x));
  return png(64, 64, bytes);
}

const MATERIALS = [
  { name: "floor", pbrMetallicRoughness: { baseColorFactor: [0.8, 0.7, 0.6, 1], metallicFactor: 0, roughnessFactor: 0.9 }, normalTexture: { index: 0 } },
  { name: "ball", pbrMetallicRoughness: { baseColorFactor: [0.9, 0.6, 0.3, 1], metallicFactor: 0.6, roughnessFactor: 0.35 } },
  {
    name: "Lantern",
    emissiveFactor: [0.2, 0.15, 0.05],
    pbrMetallicRoughness: { baseColorFactor: [0.5, 0.5, 0.9, 1], metallicFactor: 0, roughnessFactor: 0.5 },
    extensions: { KHR_materials_clearcoat: { clearcoatFactor: 0.8, clearcoatRoughnessFactor: 0.1 } },
  },
];

/** Cluster and weights of a vertex from its words. */
function unpacked([low, high]) {
  const bits = (BigInt(high) << 32n) | BigInt(low);
  const cluster = low & (2 ** CLUSTER_BITS - 1);
  let at = CLUSTER_BITS;
  const weights = WIDTHS[cluster].map((width) => {
    const most = 2 ** width - 1;
    const q = Number((bits >> BigInt(at)) & BigInt(most));
    at += width;
    return (2 * q - most) / most;
  });
  return { cluster, weights: [...weights, 0, 0, 0, 0].slice(0, 4) };
}

/** Returns the attributes of unpacked weights. */
function weightAttributes(binary, words) {
  const vertices = words.map(unpacked);
  const bytes = new Uint8Array(4 * vertices.length); // each cluster in four
  vertices.forEach(({ cluster }, v) => (bytes[4 * v] = cluster));
  binary.accessors.push({ bufferView: binary.view(bytes, { byteStride: 4 }), componentType: 5121, count: vertices.length, type: "SCALAR" });
  return {
    _PRT_CLUSTER: binary.accessors.length - 1,
    _PRT_WEIGHTS_0: binary.accessor(new Float32Array(vertices.flatMap(({ weights }) => weights)), "VEC4"),
  };
}

/** Predictors of vertices, for each way to store weights. */
const PREDICTORS = {
  vertices: [{ kind: "normal", scale: [1, 1, 1] }],
  weights: [{ kind: "normal", scale: [1, 1, 1] }, { kind: "position", origin: [0.1, 0.2, -0.1], scale: [0.3, 0.3, 0.3] }],
};

/** Returns the set of vertices; `by`: see bakedModel. */
export function vertexSet(binary, by) {
  const predictors = PREDICTORS[by] ?? PREDICTORS.vertices;
  const rows = 3 * predictors.length;
  const { packing, ...rest } = clusters(binary, rows);
  const set = { receivers: "vertices", ...rest, ...(by === "weights" ? {} : { packing }) };
  const none = new Array(rows).fill(0);
  return { ...set, predictors, centers: { bufferView: binary.view(encodedRows(none, COMPONENTS.map(() => [0, none]))), drops: none } };
}

/** Returns the set of texels, and adds its images. */
export function texelSet(json, binary) {
  const maps = MAPS.map((map, i) => {
    const first = json.images.length;
    json.images.push(...images(binary, map.width, map.height, (x, y) => texelWords(i, x, y)));
    return { ...map, images: [first, first + 1] };
  });
  return { receivers: "texels", ...clusters(binary, 0), maps };
}

/**
 * Returns the file. `by` is "vertices", "weights" (of vertices, not packed), "texels", or "both": texels and vertices;
 * `change(json, binary)` may modify it.
 */
export function bakedModel(by, change = () => {}) {
  const binary = new Binary();
  const shapes = [new PlaneGeometry(4, 4, 24, 24).rotateX(-Math.PI / 2), new SphereGeometry(0.7, 40, 24).translate(-0.5, 1, 0), new SphereGeometry(0.35, 24, 16).translate(0.9, 0.5, 0.6)];
  const isMapped = by === "texels" || by === "both";
  const json = { extensionsUsed: ["KHR_materials_clearcoat", "KHR_materials_unlit"], scene: 0, scenes: [{ nodes: [0, 1, 2] }], nodes: [{ mesh: 0 }, { mesh: 1 }, { mesh: 2 }], materials: MATERIALS };
  json.images = [{ bufferView: binary.view(normalMap()), mimeType: "image/png" }];
  json.textures = [{ source: 0 }];
  json.meshes = shapes.map(({ attributes: { position, normal, uv }, index }, i) => {
    position.array = new Float32Array(position.array);
    const attributes = {
      POSITION: binary.accessor(position.array, "VEC3", { min: [-9, -9, -9], max: [9, 9, 9] }),
      NORMAL: binary.accessor(new Float32Array(normal.array), "VEC3"),
      TEXCOORD_0: binary.accessor(new Float32Array(uv.array), "VEC2"),
    };
    const primitive = { attributes, indices: binary.accessor(new Uint32Array(index.array), "SCALAR"), material: i };
    if (isMapped) {
      attributes.TEXCOORD_1 = binary.accessor(new Float32Array(uv.array), "VEC2");
      primitive.extensions = { PRTKIT_transfer: { map: i % 2, texCoord: i === 2 ? 0 : 1 } };
    }
    if (by !== "texels") {
      const words = Array.from({ length: position.count }, (_, v) => wordsAt(uv.getX(v), uv.getY(v), i));
      if (by === "weights") Object.assign(attributes, weightAttributes(binary, words));
      else
        for (let j = 0; j < WORDS; ++j)
          attributes[`_PRT_WEIGHTS_${j}`] = binary.accessor(new Uint8Array(Uint32Array.from(words, (own) => own[j]).buffer), "VEC4");
    }
    return { primitives: [primitive] };
  });
  const sets = [];
  if (by !== "texels") sets.push(vertexSet(binary, by));
  if (isMapped) sets.push(texelSet(json, binary));
  json.extensions = transferOf(...sets);
  change(json, binary);
  return binary.file(json);
}
