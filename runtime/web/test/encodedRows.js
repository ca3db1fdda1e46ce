// An encoder of the "coded rows" of docs/format.md, for tests.

/** Returns the bytes of rows, each [level, numbers]. */
export function encodedRows(drops, rows) {
  const bytes = [];
  let low = 0;
  let range = 2 ** 32 - 1;
  const shiftOut = () => {
    if (low >= 2 ** 32) {
      let i = bytes.length - 1;
      while (bytes[i] === 255) bytes[i--] = 0;
      ++bytes[i];
      low -= 2 ** 32;
    }
    bytes.push(Math.floor(low / 2 ** 24));
    low = (low % 2 ** 24) * 256;
  };
  const take = (one, bound) => {
    if (!one) low += bound;
    range = one ? bound : range - bound;
    for (; range < 2 ** 24; range *= 256) shiftOut();
  };
  const plain = (value, width) => {
    for (let i = width - 1; i >= 0; --i) take((value >> i) & 1, Math.floor(range / 2));
  };
  const models = new Map();
  const modelled = (one, name) => {
    const model = models.get(name) ?? { p: 32768, n: 0 };
    take(one, Math.floor(range / 65536) * model.p);
    const p = model.p + Math.trunc(((one ? 65536 : 0) - model.p) / (model.n + 2));
    models.set(name, { p: Math.min(Math.max(p, 64), 65472), n: Math.min(model.n + 1, 62) });
  };
  for (const [level, numbers] of rows) {
    plain(level, 4);
    numbers.forEach((value, i) => {
      const width = level - drops[i];
      if (width <= 0) return;
      modelled(value === 0, `zero ${width}`);
      if (value === 0) return;
      plain(value < 0 ? 1 : 0, 1);
      const below = Math.floor(Math.log2(Math.abs(value)));
      for (let b = 0; b < Math.min(below + 1, width - 1); ++b) modelled(b < below, `longer ${width} ${b}`);
      if (below === 0) return;
      modelled((Math.abs(value) >> (below - 1)) & 1, `second ${width} ${below}`);
      plain(Math.abs(value), below - 1);
    });
  }
  for (let i = 0; i < 4; ++i) shiftOut();
  return new Uint8Array(bytes);
}
