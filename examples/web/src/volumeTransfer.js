// Transfer of probes: PRTKIT_transfer_volume. No three.js here.

import { clustersOf } from "./clusteredPca.js";
import { wordsOf } from "./packedWords.js";
import { gridOf } from "./volumeGrid.js";
import { checkVolume, expect, inNameOf, PROBES, viewsOf } from "./wholeExtension.js";

const holds = (value, what) => expect(value, what, PROBES);

const viewed = (Type, bytes) => new Type(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));

/** Throws unless `words`, of which a probe has `stride`, name clusters that are there. */
function checkWords(words, stride, { clusterBits, components }) {
  const mask = 2 ** clusterBits - 1;
  for (let at = 0; at < words.length; at += stride)
    holds((words[at] & mask) < components.length, `probe ${at / stride} is in no cluster`);
}

/**
 * Decodes the volume of a file with `extension`: { grid, order, clusters, visibility, words, stride }, with
 * `order` that of incident light, `words` [probes][stride]. `view(i)`: the bytes of buffer view i. Throws an
 * Error with the reason for a damaged file.
 */
export function volumeOf(extension, view) {
  checkVolume(extension);
  const bytes = viewsOf(extension).reduce((sum, i) => sum + view(i).byteLength, 0);
  const grid = gridOf(extension, view(extension.bricks.bufferView), bytes);
  const probes = grid.levels.length;
  const visibility = view(extension.visibility.bufferView);
  holds(visibility.byteLength === 6 * probes, `there are ${probes} probes, and visibility for ${visibility.byteLength / 6}`);
  const order = extension.incidentOrder;
  const clusters = inNameOf(PROBES, () => clustersOf(extension, view, order * order));
  const stride = wordsOf(clusters);
  holds(stride <= 8, `a probe has ${stride} words of packed weights, more than 8`);
  const packed = view(extension.words.bufferView);
  holds(packed.byteLength === 4 * stride * probes, `the words are not those of ${probes} probes`);
  const words = viewed(Uint32Array, packed);
  checkWords(words, stride, clusters);
  return { grid, order, clusters, visibility: viewed(Uint8Array, visibility), words, stride };
}
