// Compares the decoder of runtime/web with vectors:
//   node decode_web.mjs BAKED SHIPPED
// Prints the maximum difference, over vertices and colours, between the exit radiance of SHIPPED from the constants of its
// shader and that of the vectors in BAKED, under a light of arbitrary coefficients, relative to the maximum radiance.
import { readFileSync } from "node:fs";
import { clustersOf, updateConstants, lightColumns, shaderRows } from "../../runtime/web/src/clusteredPca.js";
import { setsOf } from "../../runtime/web/src/wholeExtension.js";

function open(path) {
  const file = readFileSync(path);
  const length = file.readUInt32LE(12);
  const json = JSON.parse(file.subarray(20, 20 + length).toString("utf8"));
  const binary = file.subarray(28 + length);
  const view = (i) => {
    const { byteOffset = 0, byteLength } = json.bufferViews[i];
    return new Uint8Array(binary.subarray(byteOffset, byteOffset + byteLength));
  };
  const floats = (i) => new Float32Array(view(i).buffer);
  return { json, view, floats };
}

const baked = open(process.argv[2]);
const shipped = open(process.argv[3]);
const clusters = clustersOf(setsOf(shipped.json).vertices, shipped.view);
const { order, terms, predictors, firstRows, components, widths, clusterBits } = clusters;
const sky = Array.from({ length: 3 * order * order }, (_, i) => Math.cos(i + 1));
const columns = lightColumns(clusters, sky);
const constants = updateConstants(clusters, shaderRows(clusters), columns, new Float32Array(4 * clusters.rowCount));
const raw = { order, terms, rowCount: 0 };

const [primitive] = shipped.json.meshes[0].primitives;
const attribute = (name) => shipped.floats(shipped.json.accessors[primitive.attributes[name]].bufferView);
const positions = attribute("POSITION");
const normals = attribute("NORMAL");
const words = shipped.view(shipped.json.accessors[primitive.attributes._PRT_WEIGHTS_0].bufferView);
const vectors = baked.floats(baked.json.meshes[0].primitives[0].extensions.PRTKIT_transfer.vectors.bufferView);

const count = positions.length / 3;
const expected = updateConstants({ ...raw, rowCount: count }, vectors, columns, new Float32Array(4 * count));
let difference = 0;
let largest = 0;
for (let v = 0; v < count; ++v) {
  let bit = 32 * v;
  const take = (width) => {
    let value = 0;
    for (let b = 0; b < width; ++b, ++bit) value += ((words[bit >> 3] >> (bit & 7)) & 1) * 2 ** b;
    return value;
  };
  const cluster = take(clusterBits);
  const known = predictors.flatMap(({ kind, origin }) =>
    [0, 1, 2].map((i) => (kind === "normal" ? normals[3 * v + i] : positions[3 * v + i] - origin[i])),
  );
  const factors = [1, ...known, ...Array.from({ length: components[cluster] }, (_, j) => take(widths[cluster][j]))];
  for (let c = 0; c < 3; ++c) {
    const sum = factors.reduce((total, factor, j) => total + factor * constants[4 * (firstRows[cluster] + j) + c], 0);
    difference = Math.max(difference, Math.abs(sum - expected[4 * v + c]));
    largest = Math.max(largest, Math.abs(expected[4 * v + c]));
  }
}
console.log(difference / largest);
