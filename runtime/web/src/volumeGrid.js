// Positions of the probes of a volume (docs/format.md, "Probes"). Does not use three.js.

import { expect, PROBES } from "./wholeExtension.js";

const holds = (value, what) => expect(value, what, PROBES);

/** Cells along a side of a brick, and probes; levels of bricks. */
const CELLS = 4;
export const SIDE = CELLS + 1;
export const BRICK_PROBES = SIDE ** 3;
const MOST_LEVEL = 3;
/** Value of the index without a brick. */
export const NO_BRICK = 0xffffffff;

/** Throws if a volume would need more memory than is allowed for a file of `bytes`. */
function checkMemory(taken, bytes) {
  holds(taken <= 256e6 + 64 * bytes, `the volume would need ${Math.round(taken / 1e6)} MB`);
}

/** Returns the index of the brick of each cell, [size z][size y][size x]. */
function indexOf({ size, bricks }) {
  const index = new Uint32Array(size[0] * size[1] * size[2]).fill(NO_BRICK);
  for (let b = 0; b < bricks.length / 4; ++b) {
    const [x, y, z, level] = bricks.subarray(4 * b, 4 * b + 4);
    const end = [x, y, z].map((least, axis) => Math.min(least + 2 ** level, size[axis]));
    for (let k = z; k < end[2]; ++k)
      for (let j = y; j < end[1]; ++j) {
        const row = (k * size[1] + j) * size[0];
        holds(index.subarray(row + x, row + end[0]).every((n) => n === NO_BRICK), "two bricks overlap");
        index.fill(b, row + x, row + end[0]);
      }
  }
  return index;
}

/** Returns corner `i` of brick `b`, in finest cells. */
function cornerOf(bricks, b, i) {
  const width = 2 ** bricks[4 * b + 3];
  const steps = [i % SIDE, Math.floor(i / SIDE) % SIDE, Math.floor(i / SIDE ** 2)];
  return steps.map((step, axis) => CELLS * bricks[4 * b + axis] + width * step);
}

/** Returns the probes: corners that bricks share are one probe, numbered in the order of their first use. */
function probesOf(bricks) {
  const ofBrick = new Uint32Array((BRICK_PROBES * bricks.length) / 4);
  const corners = [];
  const levels = [];
  const numbers = new Map();
  for (let e = 0; e < ofBrick.length; ++e) {
    const b = Math.floor(e / BRICK_PROBES);
    const corner = cornerOf(bricks, b, e % BRICK_PROBES);
    const key = (corner[2] * 8192 + corner[1]) * 8192 + corner[0]; // coordinates are at most 4 (1024 + 8)
    let probe = numbers.get(key);
    if (probe === undefined) {
      probe = levels.length;
      numbers.set(key, probe);
      corners.push(...corner);
      levels.push(0);
    }
    levels[probe] = Math.max(levels[probe], bricks[4 * b + 3]);
    ofBrick[e] = probe;
  }
  return { ofBrick, corners: Uint16Array.from(corners), levels: Uint8Array.from(levels) };
}

/**
 * Returns the grid of a validated extension: `origin`, `spacing` and `size` as in the file, `bricks` [n][4],
 * `index`, and for the probes `ofBrick` [n][125], their `corners` [probes][3] in finest cells and `levels`
 * [probes], that of the coarsest brick with the probe. `numbers`: the bytes of the bricks; `bytes`: size of
 * the volume in the file.
 */
export function gridOf({ origin, spacing, size }, numbers, bytes) {
  checkMemory(16 * size[0] * size[1] * size[2], bytes);
  holds(numbers.byteLength > 0 && numbers.byteLength % 8 === 0, "the bricks are not groups of eight bytes");
  checkMemory((numbers.byteLength / 8) * BRICK_PROBES * 64, bytes);
  const bricks = new Uint16Array(numbers.buffer.slice(numbers.byteOffset, numbers.byteOffset + numbers.byteLength));
  for (let i = 0; i < bricks.length; i += 4) {
    const level = bricks[i + 3];
    const isInside = level <= MOST_LEVEL && size.every((most, axis) => bricks[i + axis] < most && bricks[i + axis] % 2 ** level === 0);
    holds(isInside, "a brick is outside the volume");
  }
  return { origin, spacing, size, bricks, index: indexOf({ size, bricks }), ...probesOf(bricks) };
}

/** Returns the position of a probe in metres, in world space of the file. */
export function positionOf({ origin, spacing, corners }, probe) {
  return origin.map((least, axis) => least + spacing * corners[3 * probe + axis]);
}
