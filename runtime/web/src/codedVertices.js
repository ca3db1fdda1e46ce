// Decodes words of vertices before GLTFLoader reads a file: they become ordinary attributes.

import { packedWidths } from "./clusteredPca.js";
import { codedWords, earlierNeighbors } from "./codedWords.js";
import { primitivesOf } from "./fallback.js";
import { wordsOf } from "./packedWords.js";
import { expect, TRANSFER } from "./wholeExtension.js";

const STRIP = 5;
const FAN = 6;
const BYTES_PER_VERTEX = 120; // memory per vertex in addition to its words

/** Returns the corners of the triangles of a primitive, each three in any order. */
async function trianglesOf(parser, { indices, mode }, count) {
  const accessor = indices === undefined ? null : await parser.getDependency("accessor", indices);
  const list = Array.from({ length: accessor ? accessor.count : count }, (_, i) => (accessor ? accessor.getX(i) : i));
  expect(list.every((index) => index < count), `an index of a primitive exceeds its ${count} vertices`);
  if (mode === STRIP) return list.slice(2).flatMap((last, i) => [list[i], list[i + 1], last]);
  if (mode === FAN) return list.slice(2).flatMap((last, i) => [list[0], list[i + 1], last]);
  return list.slice(0, list.length - (list.length % 3));
}

/** Returns the primitives with coded words: { primitive, first, count }. */
function codedPrimitives(json, vertices) {
  const coded = [];
  for (const primitive of primitivesOf(json)) {
    const first = primitive.extensions?.[TRANSFER]?.firstVertex;
    if (first === undefined) continue;
    const count = json.accessors?.[primitive.attributes.POSITION]?.count;
    expect(Number.isInteger(first) && first >= 0 && first + count <= vertices, `a primitive uses coded words beyond the ${vertices} of the file`);
    coded.push({ primitive, first, count });
  }
  return coded;
}

/** Replaces coded words of a set of vertices in the JSON of `parser` by attributes. `views(list)`: the bytes of buffer views. */
export async function decodeVertices(parser, set, views) {
  const { json } = parser;
  const { packing } = set;
  if (!packing?.words) return;
  const { vertices, bufferView, frequencies } = packing.words;
  const bytes = await views([bufferView, packing.bufferView]);
  const clusters = { widths: packedWidths(set, (i) => bytes.get(i)), clusterBits: packing.clusterBits };
  const words = wordsOf(clusters);
  const all = bytes.get(bufferView);
  expect(frequencies.byteLength <= all.length, "the frequencies of the coded words end too early");
  expect(vertices * (BYTES_PER_VERTEX + 16 * words) <= 256e6 + 64 * all.length, `${vertices} coded vertices need too much memory`);
  const primitives = codedPrimitives(json, vertices);
  const triangles = [];
  for (const { primitive, first, count } of primitives)
    for (const corner of await trianglesOf(parser, primitive, count)) triangles.push(first + corner);
  const code = { frequencies: all.subarray(0, frequencies.byteLength), drops: frequencies.drops, bits: all.subarray(frequencies.byteLength) };
  const decoded = codedWords(code, clusters, earlierNeighbors(triangles, vertices));
  parser.cache.add(`bufferView:${json.bufferViews.length}`, Promise.resolve(decoded.buffer));
  json.bufferViews.push({ buffer: 0, byteLength: decoded.byteLength, byteStride: 4 * words });
  const accessors = new Map(); // primitives may share their vertices
  for (const { primitive, first, count } of primitives) {
    const key = `${first} ${count}`;
    if (!accessors.has(key)) {
      accessors.set(key, json.accessors.length);
      for (let w = 0; w < words; ++w)
        json.accessors.push({ bufferView: json.bufferViews.length - 1, byteOffset: 4 * (first * words + w), componentType: 5121, count, type: "VEC4" });
    }
    for (let w = 0; w < words; ++w) primitive.attributes[`_PRT_WEIGHTS_${w}`] = accessors.get(key) + w;
    delete primitive.extensions[TRANSFER].firstVertex;
  }
  delete packing.words;
}

/** Removes the attributes of transfer of vertices, which are not shown, from the primitives of `json`. */
export function removeWeights(json) {
  for (const { attributes = {} } of primitivesOf(json))
    for (const name of Object.keys(attributes)) if (/^_PRT_(CLUSTER|WEIGHTS_\d+)$/.test(name)) delete attributes[name];
}
