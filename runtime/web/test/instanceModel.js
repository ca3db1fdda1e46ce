// A small model whose balls are instances with shared transfer, as `prt bake --instances shared` and `prt
// compress` write it, with synthetic transfer and factors.
import { bakedModel, COMPONENTS } from "./bakedModel.js";
import { setIn } from "./transferSets.js";

export const PARTS = [
  { kind: "direct", channels: 1 },
  { kind: "indirect", channels: 3 },
];
const SIZE = 4 + 3 * 4;
export const BOXES = [
  { middle: [-0.5, 1, 0], half: [0.7, 0.7, 0.7] },
  { middle: [0.9, 0.5, 0.6], half: [0.35, 0.35, 0.35] },
];
export const COUNT = 6;

function random(seed) {
  let state = seed;
  return () => (state = (state * 1664525 + 1013904223) % 2 ** 32) / 2 ** 32;
}

/** Returns the numbers of all instances, [COUNT][52]: much of the light is transmitted, some is reflected. */
function numbers() {
  const next = random(17);
  const row = (mean) => [0.3 * (next() - 0.5), 0.3 * (next() - 0.5), 0.3 * (next() - 0.5), mean + 0.2 * (next() - 0.5)];
  const color = (mean) => [0, 0, 0].map(() => mean + 0.1 * (next() - 0.5));
  const all = Array.from({ length: COUNT }, () =>
    [row(0.8), row(0), row(0), row(0.1), ...[4, 5, 6, 7, 8].map(() => row(0.05)), row(0.5), color(0.2), color(0.05), color(0), color(0)].flat(),
  );
  return all.flat();
}

const base = Array.from({ length: 52 }, (_, j) => Number(j === 3 || j === 39));
/** A different scale for each number, so that exchanged numbers are detected. */
export const SCALES = base.map((_, j) => 0.01 + 0.0001 * j);

/** Their bytes, as a file has them. */
export function bytes() {
  return Int8Array.from(numbers(), (value, n) => Math.round((value - base[n % 52]) / SCALES[n % 52]));
}

/** Returns the decoded factors. */
export function factors() {
  return Array.from(bytes(), (q, n) => base[n % 52] + SCALES[n % 52] * q);
}

const half = Math.SQRT1_2;
/** Instances rotated by nothing, by a bin of yaw, by yaw between bins, and tilted. */
export const PLACES = {
  TRANSLATION: [-1.5, 0, -1, 1, 0.2, -1, 0.4, 0, 1.2, -1, 0.5, 1],
  ROTATION: [0, 0, 0, 1, 0, half, 0, half, 0, Math.sin(0.51), 0, Math.cos(0.51), 0.48, 0.36, 0, 0.8],
  SCALE: [0.5, 0.5, 0.5, 0.6, 0.6, 0.6, 0.4, 0.4, 0.4, 0.5, 0.5, 0.5],
};

/** Names of the lamps of a model with lamps. */
export const LAMPS = ["Lantern", "Fire"];

/** Returns the light of the lamps at all instances, as a file has it: a scale and 300 bytes for each. */
export function lampBytes() {
  const next = random(23);
  const data = new DataView(new ArrayBuffer(304 * COUNT * LAMPS.length));
  for (let n = 0; n < COUNT * LAMPS.length; ++n) {
    data.setFloat32(304 * n, 0.001 * (n + 1), true);
    for (let j = 0; j < 300; ++j) data.setInt8(304 * n + 4 + j, Math.round(254 * next() - 127));
  }
  return new Uint8Array(data.buffer);
}

/** Returns number j (function, colour, and position) of the light of lamp `lamp` at instance `instance`. */
export function lampNumber(instance, lamp, j) {
  const data = new DataView(lampBytes().buffer);
  const at = 304 * (LAMPS.length * instance + lamp);
  return data.getFloat32(at, true) * data.getInt8(at + 4 + j);
}

/** Returns the file, without lamps or with LAMPS; `by`: see bakedModel; `change(json, binary)` may modify it. */
export function instanceModel(by = "vertices", change = () => {}, lamps = []) {
  return bakedModel(by, (json, binary) => {
    const clusters = setIn(json, "vertices");
    const predictors = 3 * clusters.predictors.length;
    const next = random(7);
    const row = (most, mean) => Array.from({ length: SIZE + 3 * lamps.length }, (_, a) => (mean && a % 4 === 0 ? 0.25 : 0) + most * (next() - 0.5));
    const rows = COMPONENTS.flatMap((m) => [...row(0.05, true), ...Array.from({ length: predictors + m }, () => row(0.08, false)).flat()]);
    Object.assign(clusters, { terms: [...PARTS, ...lamps.map((name) => ({ kind: "lamp", channels: 3, name }))], bases: { bufferView: binary.view(Float32Array.from(rows)), componentType: 5126 } });
    json.materials = json.materials.map(({ normalTexture: _, ...material }) => ({ ...material, emissiveFactor: [0, 0, 0] }));
    delete json.images;
    delete json.textures;
    const attributes = Object.fromEntries(
      Object.entries(PLACES).map(([name, values]) => [name, binary.accessor(new Float32Array(values), name === "ROTATION" ? "VEC4" : "VEC3")]),
    );
    json.nodes = [
      { mesh: 0 },
      { mesh: 1, extensions: { EXT_mesh_gpu_instancing: { attributes }, PRTKIT_instances: { first: 0, box: 0 } } },
      { name: "hill", translation: [0.5, 0, -0.5], rotation: [0, half, 0, half], children: [3, 4] },
      { mesh: 2, translation: [0.3, 0.1, 0], extensions: { PRTKIT_instances: { first: 4, box: 1 } } },
      { mesh: 2, translation: [-1, 0.1, 1], scale: [1.5, 1.5, 1.5], extensions: { PRTKIT_instances: { first: 5, box: 1 } } },
    ];
    json.scenes = [{ nodes: [0, 1, 2] }];
    json.extensionsUsed.push("EXT_mesh_gpu_instancing", "PRTKIT_instances");
    json.extensions.PRTKIT_instances = {
      version: 3,
      count: COUNT,
      factors: { bufferView: binary.view(bytes()), scales: SCALES },
      boxes: BOXES,
      ...(lamps.length > 0 && { lamps: { count: lamps.length, bufferView: binary.view(lampBytes()) } }),
    };
    change(json, binary);
  });
}
