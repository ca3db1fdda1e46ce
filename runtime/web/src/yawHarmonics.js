// Constants of clusters under light rotated about +Y: a rotation mixes only azimuthal orders m and -m, so
// that constants are series of cos(m yaw) and sin(m yaw), which are cheap for several rotations. Does not use
// three.js.

import { polarMatrices, ShLight } from "./sphericalHarmonics.js";

/** Returns `rows` [rowCount] for coefficients whose polar axis is +Y. */
export function polarRows({ order, terms }, rows) {
  const matrices = polarMatrices(order);
  const count = order * order;
  const result = new Float64Array(rows.length);
  const channels = terms.reduce((sum, term) => sum + term.channels, 0);
  for (let first = 0; first < rows.length; first += count * channels)
    for (let block = first; block < first + count * channels; block += count)
      matrices.forEach((matrix, l) => {
        const size = 2 * l + 1;
        for (let i = 0; i < size; ++i)
          for (let j = 0; j < size; ++j) result[block + l * l + j] += matrix[i * size + j] * rows[block + l * l + i];
      });
  return result;
}

/** Number of values in a series. */
export const seriesSize = (order) => 2 * order - 1;

/** Returns 1, cos(yaw), sin(yaw), cos(2 yaw), .. */
export function rotationTerms(order, yaw) {
  const terms = Float64Array.of(1, ...new Array(seriesSize(order) - 1).fill(0));
  for (let m = 1; m < order; ++m) [terms[2 * m - 1], terms[2 * m]] = [Math.cos(m * yaw), Math.sin(m * yaw)];
  return terms;
}

/**
 * Computes the series of each row and colour, [rows][3][seriesSize(order)], of light in spaces rotated by a yaw:
 * `rows` of polarRows; coefficients [order²][3] of `sky`, for direct terms, and of all light, for the other
 * terms.
 */
export function yawSeries({ order, terms, rowCount }, rows, sky, all, series) {
  const [direct, rest] = [sky, all].map((light) => ShLight.fromCoefficients(order, light).polar);
  const count = order * order;
  const size = seriesSize(order);
  series.fill(0);
  let at = 0;
  for (let r = 0; r < rowCount; ++r)
    for (const { kind, channels } of terms) {
      const light = kind === "direct" ? direct : rest;
      for (let c = 0; c < 3; ++c) {
        const own = at + (channels === 3 ? c * count : 0);
        const to = (3 * r + c) * size;
        for (let l = 0; l < order; ++l) {
          const middle = l * l + l;
          series[to] += rows[own + middle] * light[3 * middle + c];
          for (let m = 1; m <= l; ++m) {
            // factors of cos and sin of the azimuth
            const [even, odd] = [rows[own + middle + m], rows[own + middle - m]];
            const [p, q] = [light[3 * (middle + m) + c], light[3 * (middle - m) + c]];
            series[to + 2 * m - 1] += even * p + odd * q;
            series[to + 2 * m] += even * q - odd * p;
          }
        }
      }
      at += channels * count;
    }
}

/** Writes constants [rows][4] of rows [first, end) at the yaw of `terms` (rotationTerms). */
export function updateAtYaw(series, terms, first, end, constants) {
  const count = terms.length;
  for (let row = first; row < end; ++row)
    for (let c = 0; c < 3; ++c) {
      const from = (3 * row + c) * count;
      let sum = 0;
      for (let k = 0; k < count; ++k) sum += terms[k] * series[from + k];
      constants[4 * row + c] = sum;
    }
}
