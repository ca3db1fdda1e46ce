// Lighting of instances that share the transfer of their mesh (docs/format.md, PRTKIT_instances): its modes,
// and the rotations for which it is computed, like prt::InstanceModes and prt::instance_rotations. Does not use
// three.js.

import { evaluateSh, gaussLegendre } from "./sphericalHarmonics.js";

const ABOVE_BANDS = 3;
const ABOVE_MODES = ABOVE_BANDS ** 2;
/** Modes of transmitted light: light from above the horizon times √(4π) Y of three bands, and light from below. */
export const PASSING_MODES = ABOVE_MODES + 1;
export const ADDED_BANDS = 2;
/** Modes of reflected light: light of level ground times √(4π) Y of two bands. */
export const ADDED_MODES = ADDED_BANDS ** 2;
/** Number of factors of an instance: ten rows of four numbers, and four colours. */
export const FACTORS = 4 * PASSING_MODES + 3 * ADDED_MODES;
/** Functions of the incident light of a lamp at an instance: √(4π) Y of five bands. */
export const LAMP_FUNCTIONS = 25;
/** Number of values of this light, [LAMP_FUNCTIONS][3][4]: linear in the position, for each colour. */
export const LAMP_NUMBERS = 12 * LAMP_FUNCTIONS;
/** Scales the constant mode to 1. */
const SCALE = Math.sqrt(4 * Math.PI);

/** Modes as linear operators on the coefficients of light, in the world's axes with +Y up. */
export class InstanceModes {
  constructor(order) {
    const count = order * order;
    this.count = count;
    this.matrices = Array.from({ length: PASSING_MODES }, () => new Float64Array(count * count));
    this.level = new Float64Array(count); // weights for the irradiance of level ground
    // Exact for polynomials of twice the order in height and azimuth: products of two functions of the light
    // and one of a mode.
    const heights = gaussLegendre(order + 1);
    const around = 2 * order + 2;
    const bands = Math.max(order, ABOVE_BANDS);
    const basis = new Float64Array(bands * bands); // a basis of fewer bands is its beginning
    for (let h = 0; h <= order; ++h)
      for (let a = 0; a < around; ++a) {
        const y = 0.5 * (heights.nodes[h] + 1);
        const angle = (2 * Math.PI * a) / around;
        const [x, z] = [Math.sqrt(1 - y * y) * Math.sin(angle), Math.sqrt(1 - y * y) * Math.cos(angle)];
        const weight = (0.5 * heights.weights[h] * 2 * Math.PI) / around;
        evaluateSh(bands, x, y, z, basis);
        for (let i = 0; i < count; ++i) {
          this.level[i] += (weight * y * basis[i]) / Math.PI;
          for (let j = 0; j < count; ++j) {
            const product = weight * basis[i] * basis[j];
            for (let m = 0; m < ABOVE_MODES; ++m) this.matrices[m][i * count + j] += SCALE * basis[m] * product;
          }
        }
      }
    const [above, below] = [this.matrices[0], this.matrices[ABOVE_MODES]];
    for (let i = 0; i < count; ++i) for (let j = 0; j < count; ++j) below[i * count + j] = Number(i === j) - above[i * count + j];
  }

  /** Returns the light of the transmitted modes, each [order²][3], from coefficients of light. */
  passing(light) {
    const { count } = this;
    return this.matrices.map((matrix) => {
      const result = new Float64Array(3 * count);
      for (let i = 0; i < count; ++i)
        for (let j = 0; j < count; ++j)
          for (let c = 0; c < 3; ++c) result[3 * i + c] += matrix[i * count + j] * light[3 * j + c];
      return result;
    });
  }

  /** Returns the light on level ground, which multiplies the reflected modes. */
  onLevel(light) {
    return [0, 1, 2].map((c) => this.level.reduce((sum, factor, i) => sum + factor * light[3 * i + c], 0));
  }
}

/** Returns the response of rows to √(4π) Y in their space, [rows][functions][3]; the first are the reflected modes. */
export function responsesOf({ order, terms, rowCount }, rows, functions = ADDED_MODES) {
  const count = order * order;
  const responses = new Float64Array(3 * functions * rowCount);
  let at = 0;
  for (let r = 0; r < rowCount; ++r)
    for (const { channels } of terms) {
      for (let k = 0; k < Math.min(functions, count); ++k)
        for (let c = 0; c < 3; ++c)
          responses[3 * (functions * r + k) + c] += SCALE * rows[at + (channels === 3 ? c * count : 0) + k];
      at += channels * count;
    }
  return responses;
}

const ROUNDING = 1e-6; // rounding of quaternions in floats
const SAME = 1e-4; // tolerance of elements: 0.01 degrees

/** A rotation about +Y, [9] by columns. */
function yawMatrix(angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [c, 0, -s, 0, 1, 0, s, 0, c];
}

/**
 * Groups rotations, [9] by columns, so that light is computed for few: `rotations`, the index `of` each into
 * them, and `yaws`, about +Y, null for others.
 * Rotations about +Y fall into `bins` of equal yaw; equal rotations are merged for others, and for all if
 * `bins` is 0.
 */
export function instanceRotations(all, bins) {
  const rotations = [];
  const yaws = [];
  const known = new Map();
  const of = Uint32Array.from(all, (rotation) => {
    const isUpright = Math.hypot(rotation[3], rotation[4] - 1, rotation[5]) < ROUNDING;
    const bin = Math.round((Math.atan2(rotation[6], rotation[0]) / (2 * Math.PI) + 1) * bins) % bins;
    const binned = bins > 0 && isUpright;
    const key = binned ? bin : rotation.map((value) => Math.round(value / SAME)).join();
    if (!known.has(key)) {
      const yaw = binned ? (2 * Math.PI * bin) / bins : null;
      known.set(key, rotations.push(binned ? yawMatrix(yaw) : rotation) - 1);
      yaws.push(yaw);
    }
    return known.get(key);
  });
  return { rotations, yaws, of };
}
