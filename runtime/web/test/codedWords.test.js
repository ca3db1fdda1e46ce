// Tests the decoder of entropy-coded words.

import assert from "node:assert/strict";
import { test } from "node:test";
import { codedWords, earlierNeighbors } from "../src/codedWords.js";
import { encodedRows } from "./encodedRows.js";

/** Returns the bytes of steps [frequency, first slot, bits], encoded in reverse order of docs/format.md. */
function encodedSteps(steps) {
  const units = [];
  const states = [65536, 65536, 65536, 65536];
  for (let i = steps.length - 1; i >= 0; --i) {
    const [frequency, first, bits] = steps[i];
    let state = states[i % 4];
    if (state >= frequency * 2 ** (32 - bits)) {
      units.push(state % 65536);
      state = Math.floor(state / 65536);
    }
    states[i % 4] = Math.floor(state / frequency) * 2 ** bits + (state % frequency) + first;
  }
  const all = [...states.flatMap((state) => [state % 65536, Math.floor(state / 65536)]), ...units.reverse()];
  return Uint8Array.from(all.flatMap((unit) => [unit & 255, unit >> 8]));
}

const DROPS = new Array(16).fill(0);
/**
 * Contexts that STEPS use: for clusters by the previous ones (the previous cluster, one, two equal, three
 * equal, and a, b, a); for weights of 2, 3 and 6 bits.
 */
const USED = [[0, 1, 2, 4, 6], [], [0], [0, 1, 2, 3], [], [], [0, 1, 3, 4]];
/** Returns rows of frequencies: equal for all symbols in these contexts, zero in others. */
function evenFrequencies() {
  const rows = [];
  const add = (bits, contexts, symbols) => {
    for (let c = 0; c < contexts; ++c)
      for (let first = 0; first < symbols; first += 16)
        rows.push([12, Array.from({ length: 16 }, (_, s) => (USED[bits].includes(c) && first + s < symbols ? 1024 / symbols : 0))]); // an unused context has only one symbol
  };
  add(0, 9, 4);
  for (let bits = 1; bits <= 6; ++bits) add(bits, bits + 3, 2 ** bits);
  return encodedRows(DROPS, rows);
}
const even = (symbol, symbols) => [1024 / symbols, (symbol * 1024) / symbols, 10];
const plain = (value, bits) => [1, value, bits];

const TRIANGLES = [0, 1, 2, 1, 2, 3, 2, 3, 4, 1, 3, 4, 6, 0, 1, 6, 0, 2];
const CLUSTERS = { widths: [[3, 8], [2]], clusterBits: 2 };
/** Cluster and weights of each vertex. */
const FIELDS = [[0, 5, 200], [0, 4, 190], [0, 4, 194], [1, 3], [0, 6, 190], [0, 7, 190], [0, 1, 195]];
const WORDS = FIELDS.map(([cluster, a, b = 0]) => cluster | (a << 2) | (b << 5));
/**
 * The coding steps, derived by hand: differences 0, -1, 1, ... are symbols 0, 1, 2, ...; of eight bits the
 * lowest two are stored plain.
 */
const STEPS = [
  [plain(0, 2), even(2, 8), even(36, 64), plain(0, 2)], // no previous word: 4 + 1, 128 + 72
  [even(0, 4), even(1, 8), even(4, 64), plain(3, 2)], // by vertex 0: 5 - 1, 200 - 10
  [even(0, 4), even(1, 8), even(0, 64), plain(1, 2)], // by 0 and 1: 5 - 1, 195 - 1
  [even(3, 4), plain(1, 2), even(2, 4)], // a different cluster: 2 + 1
  [even(0, 4), even(4, 8), even(0, 64), plain(3, 2)], // by 2 and 1, not by 3: 4 + 2, 192 - 2
  [even(0, 4), even(2, 8), even(0, 64), plain(0, 2)], // no triangle: by the previous vertex
  [even(0, 4), even(5, 8), even(0, 64), plain(0, 2)], // by 0, 1 and 2: 4 - 3, 195
].flat();

/** Returns the only block of these few vertices, after its length. */
const block = (bytes) => Uint8Array.from([bytes.length & 255, bytes.length >> 8, 0, 0, ...bytes]);
const decoded = ({ bits = encodedSteps(STEPS), ...change } = {}) =>
  codedWords({ frequencies: evenFrequencies(), drops: DROPS, bits: block(bits), ...change }, CLUSTERS, earlierNeighbors(TRIANGLES, 7));

test("neighbours are the first three vertices before a vertex", () => {
  assert.deepEqual([...earlierNeighbors(TRIANGLES, 7)], [0, 0, 0, 0, 1, 1, 0, 1, 2, 1, 2, 3, 2, 3, 1, 5, 5, 5, 0, 1, 2]);
});

test("coded words are decoded like an example by hand", () => {
  assert.deepEqual([...decoded()], WORDS);
});

test("damaged words are rejected", () => {
  const bits = encodedSteps(STEPS);
  assert.throws(() => decoded({ bits: bits.subarray(0, bits.length - 2) }), /coded words are damaged/);
  assert.throws(() => decoded({ bits: Uint8Array.from([...bits, 0, 0]) }), /coded words are damaged/);
  assert.throws(() => decoded({ bits: new Uint8Array(0) }), /coded words are damaged/);
  const code = { frequencies: evenFrequencies(), drops: DROPS };
  for (const [wrong, message] of [[[1, 2, 3], /end too early/], [block(bits).subarray(0, 20), /end too early/], [[...block(bits), 0], /damaged/]])
    assert.throws(() => codedWords({ ...code, bits: Uint8Array.from(wrong) }, CLUSTERS, earlierNeighbors(TRIANGLES, 7)), message);
  assert.throws(() => decoded({ drops: [0] }), /1 columns, not 16/);
  assert.throws(() => decoded({ frequencies: encodedRows(DROPS, new Array(83).fill([3, new Array(16).fill(1)])) }), /sum of the frequencies is not 1024/);
  const cluster = encodedSteps([plain(3, 2), ...STEPS.slice(1)]);
  assert.throws(() => decoded({ bits: cluster }), /vertex 0 is in cluster 3 of 2/);
  const neighbor = encodedSteps([...STEPS.slice(0, 4), even(2, 4), ...STEPS.slice(5)]);
  assert.throws(() => decoded({ bits: neighbor }), /vertex 1 has the cluster of a neighbor/);
  assert.throws(() => earlierNeighbors([0, 1, 7], 7), /vertex 7 of 7/);
});
