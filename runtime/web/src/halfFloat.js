// Half floats: 16 bits, IEEE 754.

/** Returns the number with these bits. */
export function halfFloat(bits) {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  if (exponent === 31) return fraction === 0 ? sign * Infinity : NaN;
  return sign * (exponent === 0 ? fraction * 2 ** -24 : (1024 + fraction) * 2 ** (exponent - 25));
}

const LARGEST = 65504;
const number = new Float32Array(1);
const word = new Uint32Array(number.buffer);

/** Converts numbers to the nearest half floats, ties to even, limited to the largest half float. */
export function halvesOf(values, halves) {
  for (let i = 0; i < values.length; ++i) {
    const value = values[i];
    number[0] = Math.min(Math.max(value, -LARGEST), LARGEST);
    const sign = (word[0] >>> 16) & 0x8000;
    const magnitude = word[0] & 0x7fffffff;
    if (magnitude < 0x38800000) {
      number[0] = Math.abs(number[0]) + 0.5; // the last bit is now the step of the smallest half floats
      halves[i] = sign | (word[0] - 0x3f000000);
    } else halves[i] = sign | ((magnitude - 0x38000000 + 0xfff + ((magnitude >>> 13) & 1)) >>> 13);
  }
  return halves;
}
