// Converts clusters and weights of vertices from the attributes of a file to those of the shader.

import { BufferAttribute } from "three";
import { wordsOf } from "./packedWords.js";
import { expect, LARGEST_WEIGHT } from "./wholeExtension.js";

/** Returns the bytes of accessors of VEC4 of bytes, one after the other for each vertex, as 32-bit words [vertices][groups]. */
function packedWords(groups) {
  const count = groups[0].count;
  const words = new Uint32Array(count * groups.length);
  groups.forEach((group, g) => {
    for (let v = 0; v < count; ++v)
      words[v * groups.length + g] =
        (group.getX(v) | (group.getY(v) << 8) | (group.getZ(v) << 16) | (group.getW(v) << 24)) >>> 0;
  });
  return words;
}

/** Returns words [first, first + 4) of each vertex, or fewer at the end. */
function wordAttribute(words, stride, first) {
  const size = Math.min(4, stride - first);
  const count = words.length / stride;
  const own = new Uint32Array(count * size);
  for (let v = 0; v < count; ++v)
    for (let w = 0; w < size; ++w) own[v * size + w] = words[v * stride + first + w];
  return new BufferAttribute(own, size);
}

/** Returns the first `count` groups of weights, and removes all groups from the geometry. */
function takeGroups(geometry, count) {
  const groups = [];
  for (let i = 0; geometry.hasAttribute(`_prt_weights_${i}`); ++i) {
    groups.push(geometry.getAttribute(`_prt_weights_${i}`));
    geometry.deleteAttribute(`_prt_weights_${i}`);
  }
  expect(groups.length >= count, `a primitive has ${groups.length} groups of weights, not ${count}`);
  const vertices = geometry.getAttribute("position").count;
  const arrays = groups.map((group) => (group.data ?? group).array);
  expect(
    groups.every((group) => group.itemSize === 4 && group.count === vertices) &&
      arrays.every((array) => array.constructor === arrays[0].constructor),
    "the weights do not match the vertices in type or number",
  );
  return groups.slice(0, count);
}

/** Converts vertices with words to attributes of words. Returns their defines. */
function convertWords(geometry, clusters) {
  const count = wordsOf(clusters);
  expect(count <= 8, `a vertex has ${count} words of packed weights, more than 8`);
  const groups = takeGroups(geometry, count);
  expect((groups[0].data ?? groups[0]).array instanceof Uint8Array, "the packed weights are not unsigned bytes");
  const words = packedWords(groups);
  const mask = 2 ** clusters.clusterBits - 1;
  for (let i = 0; i < words.length; i += count)
    expect((words[i] & mask) < clusters.components.length, `vertex ${i / count} names a cluster that does not exist`);
  geometry.setAttribute("prt_words_0", wordAttribute(words, count, 0));
  if (count > 4) geometry.setAttribute("prt_words_1", wordAttribute(words, count, 4));
  return { PRT_PACKED_WORDS: count, PRT_CLUSTER_BITS: clusters.clusterBits };
}

/** Attributes of earlier versions: normalised integers. */
const REMOVED = new Map([[Int8Array, "snorm8"], [Int16Array, "snorm16"]]);

/** Converts vertices with a cluster and float weights. Returns their defines. */
function convertWeights(geometry, { components }) {
  const groups = takeGroups(geometry, Math.ceil(Math.max(...components) / 4));
  expect(groups.length <= 12, "a vertex has more than 48 components");
  const cluster = geometry.getAttribute("_prt_cluster");
  expect(cluster?.count === geometry.getAttribute("position").count, "a primitive has no _PRT_CLUSTER for each vertex");
  const numbers = Uint32Array.from({ length: cluster.count }, (_, v) => cluster.getX(v));
  const outside = numbers.findIndex((number) => number >= components.length);
  expect(outside < 0, `vertex ${outside} names a cluster that does not exist`);
  for (const group of groups) {
    const { array } = group.data ?? group;
    const removed = REMOVED.get(array.constructor);
    expect(!removed, `weights '${removed}' are not supported: compress again with prt compress`);
    expect(array instanceof Float32Array, "the weights are not floats");
    expect(array.every((weight) => Math.abs(weight) <= LARGEST_WEIGHT), `the weights are not finite or exceed ${LARGEST_WEIGHT}`);
  }
  geometry.deleteAttribute("_prt_cluster");
  geometry.setAttribute("prt_cluster", new BufferAttribute(numbers, 1));
  groups.forEach((group, i) => geometry.setAttribute(`prt_weights_${i}`, group));
  return { PRT_WEIGHT_VECTORS: groups.length };
}

/** Returns the bytes per vertex of the attributes of transfer. */
const bytesOf = ({ attributes }) =>
  Object.entries(attributes)
    .filter(([name]) => /^prt_(words|cluster|weights)/.test(name))
    .reduce((sum, [, { array, data, itemSize }]) => sum + itemSize * (array ?? data.array).BYTES_PER_ELEMENT, 0);

/** Replaces the attributes of the file by those of the shader: { defines, bytesPerVertex }. */
export function convertGeometry(geometry, clusters) {
  expect(geometry.hasAttribute("position"), "a primitive has no POSITION");
  const defines = clusters.widths ? convertWords(geometry, clusters) : convertWeights(geometry, clusters);
  return { defines, bytesPerVertex: bytesOf(geometry) };
}
