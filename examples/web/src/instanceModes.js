// Lighting of instances that share the transfer of their mesh (docs/format.md, PRTKIT_instances): its modes, and the turns that it
// is formed in. What prt::InstanceModes and prt::instance_turns do. No three.js here.

import { evaluateSh, gaussLegendre } from "./sphericalHarmonics.js";

/** Light from above the horizon times 1, √3 x, √3 y and √3 z; that from below. */
export const PASSING_MODES = 5;
/** What level ground throws back: evenly, and from where x, y and z are large. */
export const ADDED_MODES = 4;
/** Of an instance: five rows of four numbers, four colours. */
export const FACTORS = 4 * PASSING_MODES + 3 * ADDED_MODES;
/** Coefficients of 1, √3 x, √3 y and √3 z: each has one. */
const COEFFICIENTS = [0, 3, 1, 2];
const VALUES = [1, -1, -1, 1].map((sign) => sign * Math.sqrt(4 * Math.PI));

/** Modes as linear operators on the coefficients of light, in the world's axes with +Y up. */
export class InstanceModes {
  constructor(order) {
    const count = order * order;
    this.count = count;
    this.matrices = Array.from({ length: PASSING_MODES }, () => new Float64Array(count * count));
    this.level = new Float64Array(count); // what level ground gets
    const [above, alongX, alongY, alongZ, below] = this.matrices;
    // Exact for the polynomials that are left: of 2 order - 1 in the height, after the azimuth.
    const heights = gaussLegendre(order + 1);
    const around = 2 * order + 2;
    const basis = new Float64Array(count);
    for (let h = 0; h <= order; ++h)
      for (let a = 0; a < around; ++a) {
        const y = 0.5 * (heights.nodes[h] + 1);
        const angle = (2 * Math.PI * a) / around;
        const [x, z] = [Math.sqrt(1 - y * y) * Math.sin(angle), Math.sqrt(1 - y * y) * Math.cos(angle)];
        const weight = (0.5 * heights.weights[h] * 2 * Math.PI) / around;
        evaluateSh(order, x, y, z, basis);
        for (let i = 0; i < count; ++i) {
          this.level[i] += (weight * y * basis[i]) / Math.PI;
          for (let j = 0; j < count; ++j) {
            const product = weight * basis[i] * basis[j];
            above[i * count + j] += product;
            alongX[i * count + j] += Math.sqrt(3) * x * product;
            alongY[i * count + j] += Math.sqrt(3) * y * product;
            alongZ[i * count + j] += Math.sqrt(3) * z * product;
          }
        }
      }
    for (let i = 0; i < count; ++i) for (let j = 0; j < count; ++j) below[i * count + j] = Number(i === j) - above[i * count + j];
  }

  /** What the passing modes are lit with, each [order²][3], of coefficients of light. */
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

  /** What level ground gets of light: the added modes are lit by as much. */
  onLevel(light) {
    return [0, 1, 2].map((c) => this.level.reduce((sum, factor, i) => sum + factor * light[3 * i + c], 0));
  }
}

/** What rows make of light of 1, √3 x, √3 y and √3 z in their own frame, [rows][ADDED_MODES][3]. */
export function responsesOf({ order, parts, rowCount }, rows) {
  const count = order * order;
  const responses = new Float64Array(3 * ADDED_MODES * rowCount);
  let at = 0;
  for (let r = 0; r < rowCount; ++r)
    for (const { channels } of parts) {
      for (let k = 0; k < ADDED_MODES; ++k) {
        if (COEFFICIENTS[k] >= count) continue;
        for (let c = 0; c < 3; ++c)
          responses[3 * (ADDED_MODES * r + k) + c] += VALUES[k] * rows[at + (channels === 3 ? c * count : 0) + COEFFICIENTS[k]];
      }
      at += channels * count;
    }
  return responses;
}

const ROUNDING = 1e-6; // of quaternions in floats
const SAME = 1e-4; // of elements: 0.01 degrees

/** A rotation about +Y, [9] by columns. */
function yawMatrix(angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [c, 0, -s, 0, 1, 0, s, 0, c];
}

/**
 * The turn that each rotation, [9] by columns, is lit in, so that light is formed for few: `rotations`, which of them, `of`, and
 * `yaws`, about +Y, null for others.
 * Turns about +Y fall into `bins` of even yaw; of others those that are alike are one, and of all where `bins` is 0.
 */
export function instanceTurns(all, bins) {
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
