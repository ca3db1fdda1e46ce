// Packed words of vertices, predicted from neighbours and coded by rANS: "coded words" of docs/format.md.

import { codedRows } from "./codedRows.js";
import { wordsOf } from "./packedWords.js";
import { expect, VERTICES } from "./wholeExtension.js";

const FREQUENCY_BITS = 10;
const TOTAL = 1 << FREQUENCY_BITS;
const LEAST_STATE = 1 << 16;
const STATES = 4;
const BLOCK = 16384; // vertices per independently coded block
const COLUMNS = 16; // columns of the rows of frequencies
const SYMBOL_BITS = 6; // maximum bits of a symbol of a weight's difference
const CLUSTER_CONTEXTS = 9;
const NEW_CLUSTER = 3;
const DAMAGED = "the coded words are damaged";

/** Returns the first context of weights whose differences have symbols with this number of bits. */
const firstContext = (bits) => CLUSTER_CONTEXTS + ((bits - 1) * (bits + 6)) / 2;
const CONTEXTS = firstContext(SYMBOL_BITS + 1);
const rowsOf = (context) => (context >= firstContext(6) ? 4 : context >= firstContext(5) ? 2 : 1);
const ROWS = Array.from({ length: CONTEXTS }, (_, context) => rowsOf(context)).reduce((sum, rows) => sum + rows);

/** Returns for each slot of each context the symbol, its frequency and the slot's offset in it: [contexts][TOTAL][3]. */
function slotsOf(bytes, drops) {
  expect(drops.length === COLUMNS, `the frequencies of the coded words have ${drops.length} columns, not ${COLUMNS}`);
  const frequencies = codedRows(bytes, drops, ROWS, VERTICES);
  const slots = new Uint16Array(3 * CONTEXTS * TOTAL);
  let row = 0;
  for (let context = 0; context < CONTEXTS; ++context) {
    const own = frequencies.subarray(COLUMNS * row, COLUMNS * (row + rowsOf(context)));
    row += rowsOf(context);
    const sum = own.reduce((total, frequency) => (frequency < 0 ? NaN : total + frequency), 0);
    expect(sum === 0 || sum === TOTAL, `${DAMAGED}: the sum of the frequencies is not ${TOTAL}`);
    if (sum === 0) own[0] = TOTAL; // unused
    let slot = context * TOTAL;
    own.forEach((frequency, symbol) => {
      for (let i = 0; i < frequency; ++i) slots.set([symbol, frequency, i], 3 * slot++);
    });
  }
  return slots;
}

/** Decodes symbols of contexts, and plain bits, with four interleaved states. */
class RansDecoder {
  constructor(bytes, slots) {
    this.bytes = bytes;
    this.slots = slots;
    this.position = 0;
    this.current = 0;
    this.states = Array.from({ length: STATES }, () => {
      const low = this.unit();
      return low + 65536 * this.unit();
    });
  }
  unit() {
    const at = this.position;
    this.position += 2;
    return this.position <= this.bytes.length ? this.bytes[at] | (this.bytes[at + 1] << 8) : 0;
  }
  advance(state) {
    this.states[this.current] = state < LEAST_STATE ? state * 65536 + this.unit() : state;
    this.current = (this.current + 1) % STATES;
  }
  symbol(context) {
    const state = this.states[this.current];
    const at = 3 * (context * TOTAL + (state & (TOTAL - 1)));
    const frequency = this.slots[at + 1];
    this.advance(frequency * (state >>> FREQUENCY_BITS) + this.slots[at + 2]);
    return this.slots[at];
  }
  plain(width) {
    const state = this.states[this.current];
    this.advance(state >>> width);
    return state & ((1 << width) - 1);
  }
  endsWell() {
    return this.position === this.bytes.length && this.states.every((state) => state === LEAST_STATE);
  }
}

/**
 * Returns up to three earlier vertices along the edges of each vertex, [vertices][3]; unused entries contain
 * the vertex itself.
 */
export function earlierNeighbors(triangles, vertices) {
  const neighbors = Uint32Array.from({ length: 3 * vertices }, (_, i) => Math.floor(i / 3));
  const add = (v, before) => {
    if (Math.floor(v / BLOCK) !== Math.floor(before / BLOCK)) return; // in a different block
    for (let i = 3 * v; i < 3 * v + 3; ++i) {
      if (neighbors[i] === v) neighbors[i] = before;
      if (neighbors[i] === before) return;
    }
  };
  for (let t = 0; t + 2 < triangles.length; t += 3) {
    const [low, middle, high] = triangles.slice(t, t + 3).sort((a, b) => a - b);
    expect(high < vertices, `a triangle has vertex ${high} of ${vertices}`);
    add(middle, low);
    add(high, low);
    add(high, middle);
  }
  return neighbors;
}

/** Returns the bytes of each block. */
function blocksOf(bytes, count) {
  const tooEarly = "the coded words end too early";
  expect(4 * count <= bytes.length, tooEarly);
  const lengths = new DataView(bytes.buffer, bytes.byteOffset, 4 * count);
  let begin = 4 * count;
  const blocks = Array.from({ length: count }, (_, b) => bytes.subarray(begin, (begin += lengths.getUint32(4 * b, true))));
  expect(begin <= bytes.length, tooEarly);
  expect(begin === bytes.length, DAMAGED);
  return blocks;
}

/** Returns the vertices that predict vertex `v` (not the first of its block), the context of its cluster, and their distinct clusters. */
function prediction(clusters, neighbors, v) {
  const by = [];
  for (let i = 3 * v; i < 3 * v + 3 && neighbors[i] < v; ++i) by.push(neighbors[i]);
  if (by.length === 0) return { by: [v - 1], distinct: [clusters[v - 1]], context: 0 };
  const [a, b, c] = by.map((u) => clusters[u]);
  const distinct = [...new Set(by.map((u) => clusters[u]))];
  if (by.length === 1) return { by, distinct, context: 1 };
  if (by.length === 2) return { by, distinct, context: b === a ? 2 : 3 };
  const context = b === a ? (c === a ? 4 : 5) : c === a ? 6 : c === b ? 7 : 8;
  return { by, distinct, context };
}

const bitWidth = (value) => 32 - Math.clz32(value);

/** Returns the prediction of weight j of `width` bits from the weights of vertices `same`, and its context. */
function expected(weights, same, j, width, plain) {
  const first = firstContext(width - plain);
  if (same.length === 0) return [1 << (width - 1), first];
  const values = same.map((u) => weights[16 * u + j]);
  const sum = values.reduce((total, value) => total + value);
  if (values.length === 1) return [sum, first + 1];
  const range = Math.max(...values) - Math.min(...values);
  const mean = values.length === 2 ? (sum + 1) >> 1 : Math.floor((sum + 1) / 3);
  return [mean, first + 2 + bitWidth(range >> plain)];
}

/**
 * Returns words [vertices][words] of `code`: { frequencies, drops, bits }, the first and the last as bytes;
 * `clusters`: { widths, clusterBits }; `neighbors`: see earlierNeighbors.
 */
export function codedWords({ frequencies, drops, bits }, clusters, neighbors) {
  const { widths, clusterBits } = clusters;
  const vertices = neighbors.length / 3;
  const stride = wordsOf(clusters);
  const slots = slotsOf(frequencies, drops);
  const blocks = blocksOf(bits, Math.ceil(vertices / BLOCK));
  let decoder = null;
  const numbers = new Uint16Array(vertices);
  const weights = new Uint16Array(16 * vertices);
  const words = new Uint32Array(stride * vertices);
  for (let v = 0; v < vertices; ++v) {
    const isFirst = v % BLOCK === 0;
    if (isFirst) {
      expect(decoder?.endsWell() ?? true, DAMAGED);
      decoder = new RansDecoder(blocks[v / BLOCK], slots);
    }
    let word = stride * v;
    let shift = 0;
    const pack = (value, width) => {
      words[word] |= value << shift;
      shift += width;
      if (shift < 32) return;
      shift -= 32;
      ++word;
      if (shift > 0) words[word] = value >>> (width - shift);
    };
    const { by, distinct, context } = !isFirst ? prediction(numbers, neighbors, v) : { by: [], distinct: [], context: -1 };
    const symbol = !isFirst ? decoder.symbol(context) : NEW_CLUSTER;
    expect(symbol < distinct.length || symbol === NEW_CLUSTER, `${DAMAGED}: vertex ${v} has the cluster of a neighbor that does not exist`);
    const cluster = symbol < distinct.length ? distinct[symbol] : decoder.plain(clusterBits);
    expect(cluster < widths.length, `${DAMAGED}: vertex ${v} is in cluster ${cluster} of ${widths.length}`);
    numbers[v] = cluster;
    pack(cluster, clusterBits);
    const same = by.filter((u) => numbers[u] === cluster);
    widths[cluster].forEach((width, j) => {
      const plain = Math.max(0, width - SYMBOL_BITS);
      const [mean, own] = expected(weights, same, j, width, plain);
      let code = decoder.symbol(own);
      if (plain > 0) code = (code << plain) | decoder.plain(plain);
      const value = (mean + ((code >>> 1) ^ -(code & 1))) & ((1 << width) - 1);
      weights[16 * v + j] = value;
      pack(value, width);
    });
  }
  expect(decoder.endsWell(), DAMAGED);
  return words;
}
