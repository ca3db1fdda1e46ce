// Decodes transfer of probes. Does not use three.js.

import { clustersOf } from "./clusteredPca.js";
import { wordsOf } from "./packedWords.js";
import { gridOf } from "./volumeGrid.js";
import { expect, PROBES, viewsOf } from "./wholeExtension.js";

const holds = (value, what) => expect(value, what, PROBES);

const viewed = (Type, bytes) => new Type(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));

/** Throws if `words`, `stride` for each probe, name a cluster that does not exist. */
function checkWords(words, stride, { clusterBits, components }) {
  const mask = 2 ** clusterBits - 1;
  for (let at = 0; at < words.length; at += stride)
    holds((words[at] & mask) < components.length, `probe ${at / stride} names a cluster that does not exist`);
}

/**
 * Decodes the volume of a set of probes of setsOf: { grid, order, clusters, visibility, words, stride }, with
 * `order` that of incident light, `words` [probes][stride]. `view(i)`: the bytes of buffer view i. Throws an
 * Error with the reason for a damaged file.
 */
export function volumeOf(set, view) {
  const bytes = viewsOf(set).reduce((sum, i) => sum + view(i).byteLength, 0);
  const grid = gridOf(set, view(set.bricks.bufferView), bytes);
  const probes = grid.levels.length;
  const visibility = view(set.visibility.bufferView);
  holds(visibility.byteLength === 6 * probes, `visibility has values for ${visibility.byteLength / 6} probes, not ${probes}`);
  const order = set.incidentOrder;
  const clusters = clustersOf(set, view, order * order);
  const stride = wordsOf(clusters);
  holds(stride <= 8, `a probe has ${stride} words of packed weights, more than 8`);
  const packed = view(set.words.bufferView);
  holds(packed.byteLength === 4 * stride * probes, `the words do not have the size of ${probes} probes`);
  const words = viewed(Uint32Array, packed);
  checkWords(words, stride, clusters);
  return { grid, order, clusters, visibility: viewed(Uint8Array, visibility), words, stride };
}
