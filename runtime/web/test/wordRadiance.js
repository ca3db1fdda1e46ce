// Computes radiance of packed words in plain JavaScript, as defined in docs/format.md, for comparison with
// shaders.

/** Returns red, green and blue of the texel with `words` under the colours `columns` of all terms (lightColumns). */
export function radianceOfWords({ terms, order, components, firstRows, rows, widths, clusterBits }, columns, words) {
  const bits = words.reduce((sum, word, j) => sum | (BigInt(word) << BigInt(32 * j)), 0n);
  const take = (at, width) => Number((bits >> BigInt(at)) & ((1n << BigInt(width)) - 1n));
  const cluster = take(0, clusterBits);
  const size = terms.reduce((sum, { kind, channels }) => sum + channels * (kind === "lamp" ? 1 : order * order), 0);
  const row = (r) => rows.subarray((firstRows[cluster] + r) * size, (firstRows[cluster] + r + 1) * size);
  const vector = Float64Array.from(row(0));
  let at = clusterBits;
  for (let j = 0; j < components[cluster]; ++j) {
    const most = 2 ** widths[cluster][j] - 1;
    const weight = (2 * take(at, widths[cluster][j]) - most) / most;
    row(1 + j).forEach((value, a) => (vector[a] += weight * value));
    at += widths[cluster][j];
  }
  let [i, light] = [0, 0];
  const radiance = [0, 0, 0];
  for (const { kind, channels } of terms) {
    const count = kind === "lamp" ? 1 : order * order;
    for (let c = 0; c < 3; ++c)
      for (let k = 0; k < count; ++k) radiance[c] += vector[i + (channels === 3 ? c : 0) * count + k] * columns[light + 3 * k + c];
    i += channels * count;
    light += 3 * count;
  }
  return radiance;
}
