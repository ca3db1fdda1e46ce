// Integers in rows, arithmetically coded: "coded rows" of docs/format.md.

import { expect } from "./wholeExtension.js";

/** Returns models of `count` bits: [probability of 1 in 65536ths, number of bits seen]. */
function models(count) {
  const array = new Uint32Array(2 * count);
  for (let i = 0; i < count; ++i) array[2 * i] = 32768;
  return array;
}

class RangeDecoder {
  constructor(bytes) {
    this.bytes = bytes;
    this.position = 0;
    this.range = 0xffffffff;
    this.code = 0;
    for (let i = 0; i < 4; ++i) this.code = ((this.code << 8) | this.next()) >>> 0;
  }
  next() {
    const at = this.position++;
    return at < this.bytes.length ? this.bytes[at] : 0;
  }
  take(bound) {
    const bit = this.code < bound ? 1 : 0;
    if (bit === 0) this.code = (this.code - bound) >>> 0;
    this.range = bit ? bound : (this.range - bound) >>> 0;
    while (this.range < 0x1000000) {
      this.code = ((this.code << 8) | this.next()) >>> 0;
      this.range = (this.range << 8) >>> 0;
    }
    return bit;
  }
  bit(array, i) {
    const one = array[2 * i];
    const seen = array[2 * i + 1];
    const bit = this.take((this.range >>> 16) * one);
    const learnt = one + Math.trunc(((bit ? 65536 : 0) - one) / (seen + 2));
    array[2 * i] = Math.min(Math.max(learnt, 64), 65472);
    array[2 * i + 1] = Math.min(seen + 1, 62);
    return bit;
  }
  plain(width) {
    let value = 0;
    for (let i = 0; i < width; ++i) value = 2 * value + this.take(this.range >>> 1);
    return value;
  }
}

/** Returns a number of at most `width` bits. `own`: the models of that width: zero, longer [15], second [15]. */
function numberOf(decoder, width, own) {
  if (decoder.bit(own, 0)) return 0;
  const sign = decoder.plain(1) ? -1 : 1;
  let below = 0;
  while (below < width - 1 && decoder.bit(own, 1 + below)) ++below;
  if (below === 0) return sign;
  const top = 2 + decoder.bit(own, 16 + below);
  return sign * ((top << (below - 1)) | decoder.plain(below - 1));
}

/** Returns the numbers [rows][drops.length]. `name`: see expect. */
export function codedRows(bytes, drops, rows, name) {
  // Each row has at least four bits: a short file cannot contain many rows.
  expect(drops.length === 0 || rows / 2 <= bytes.length, "the coded rows end too early", name);
  const values = new Int16Array(rows * drops.length);
  if (drops.length === 0) return values;
  const decoder = new RangeDecoder(bytes);
  const byWidth = Array.from({ length: 16 }, () => models(31));
  for (let r = 0; r < rows; ++r) {
    const level = decoder.plain(4);
    for (let i = 0; i < drops.length; ++i)
      if (level > drops[i]) values[r * drops.length + i] = numberOf(decoder, level - drops[i], byWidth[level - drops[i]]);
    expect(decoder.position <= bytes.length, "the coded rows end too early", name);
  }
  return values;
}
