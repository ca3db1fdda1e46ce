// Numbers of the textures that shaders/prt_volume.glsl reads: runtime/include/prt/core/transfer_volume.h describes
// their layout. Does not use three.js.

import { BRICK_PROBES, NO_BRICK, SIDE } from "./volumeGrid.js";

const GUARANTEED_TEXELS = 256; // along a side of a 3D texture
/**
 * Equal to the values in shared_layout.h: maximum visibility distance in cells, and the fraction of it where
 * the weight starts to decrease.
 */
const VISIBILITY_CELLS = 4;
const VISIBILITY_FULL = 0.8;
const ROOM = 1e-3; // for rounding
const BLIND = 1e18;

/**
 * Returns the bricks along each axis of the textures, and planes of four numbers: with the minimum number of
 * layers, then with the minimum of unused texels.
 */
export function atlasOf({ bricks }, order) {
  const along = Math.floor(GUARANTEED_TEXELS / SIDE);
  const count = bricks.length / 4;
  const z = Math.max(1, Math.ceil(count / along ** 2));
  const y = Math.max(1, Math.ceil(count / (along * z)));
  const x = Math.max(1, Math.ceil(count / (y * z)));
  return { bricks: [x, y, z], planes: Math.ceil((3 * order ** 2 + 1) / 4), texels: SIDE ** 3 * x * y * z };
}

/** Returns the texel of corner `i` of brick `b` in a plane. */
export function texelOf({ bricks: [x, y] }, b, i) {
  const brick = [b % x, Math.floor(b / x) % y, Math.floor(b / (x * y))];
  const step = [i % SIDE, Math.floor(i / SIDE) % SIDE, Math.floor(i / SIDE ** 2)];
  const [u, v, w] = brick.map((n, axis) => SIDE * n + step[axis]);
  return (w * SIDE * y + v) * SIDE * x + u;
}

/**
 * True if a probe with `visibility`, as corner `step` (bits of x, y and z) of a cell, sees the whole cell.
 * `width`: the cell's width in cells of the probe.
 */
function seesCell(visibility, probe, step, width) {
  let passed = 0; // at the opposite corner; a surface is at 1
  for (let axis = 0; axis < 3; ++axis) {
    const distance = visibility[6 * probe + 2 * axis + ((step >> axis) & 1 ? 0 : 1)] / 255;
    passed = Math.max(passed, distance > 0 ? 1 / (VISIBILITY_CELLS * width * distance ** 2) : BLIND);
  }
  return passed <= VISIBILITY_FULL - ROOM;
}

/**
 * Returns [texels][2]: bytes -x, +x, -y, +y, then -z, +z, the level of the probe minus that of the brick, and
 * 1 if all eight corners of the cell see the whole cell: weights are then trilinear.
 */
export function visibilityTexels({ bricks, ofBrick, levels }, visibility, atlas) {
  const texels = new Uint32Array(2 * atlas.texels);
  const coarser = (b, i) => levels[ofBrick[BRICK_PROBES * b + i]] - bricks[4 * b + 3];
  const corner = (low, step) => low + (step & 1) + SIDE * ((step >> 1) & 1) + SIDE ** 2 * (step >> 2);
  const isSeen = (b, low) => {
    for (let step = 0; step < 8; ++step) {
      const i = corner(low, step);
      if (!seesCell(visibility, ofBrick[BRICK_PROBES * b + i], step, 2 ** coarser(b, i))) return false;
    }
    return true;
  };
  for (let b = 0; b < bricks.length / 4; ++b)
    for (let i = 0; i < BRICK_PROBES; ++i) {
      const s = visibility.subarray(6 * ofBrick[BRICK_PROBES * b + i]);
      const isCell = [i % SIDE, Math.floor(i / SIDE) % SIDE, Math.floor(i / SIDE ** 2)].every((step) => step < SIDE - 1);
      const at = 2 * texelOf(atlas, b, i);
      texels[at] = (s[0] | (s[1] << 8) | (s[2] << 16) | (s[3] << 24)) >>> 0;
      texels[at + 1] = s[4] | (s[5] << 8) | (coarser(b, i) << 16) | (Number(isCell && isSeen(b, i)) << 24);
    }
  return texels;
}

/** Returns 4 · brick + level, if there is a brick. */
export const indexTexels = ({ index, bricks }) =>
  index.map((brick) => (brick === NO_BRICK ? NO_BRICK : 4 * brick + bricks[4 * brick + 3]));
