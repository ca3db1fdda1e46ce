// Decodes the clusters of a set of PRTKIT_transfer, as defined in docs/format.md. Does not use three.js.

import { codedRows } from "./codedRows.js";
import { expect, LARGEST_TRANSFER, nameOf } from "./wholeExtension.js";

/** Returns `count` finite floats with absolute values up to `largest`. `name`: see expect. */
function floats(bytes, count, largest, what, name) {
  expect(bytes.byteLength === 4 * count, `${what} do not contain ${count} floats`, name);
  const values = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
  checkMagnitudes(values, largest, what, name);
  return values;
}

function checkMagnitudes(values, largest, what, name) {
  expect(values.every((value) => Math.abs(value) <= largest), `${what} are not finite or exceed ${largest}`, name);
}

/** Number of light columns of a term: the coefficients of a sky, or the one strength of a lamp. */
const columnsOf = (order, { kind }) => (kind === "lamp" ? 1 : order * order);

/** Size of a row: for each output a transfer vector, its terms one after the other, each [channels][columns]. */
const dimensionOf = ({ order, terms, outputs = 1 }) =>
  outputs * terms.reduce((sum, term) => sum + term.channels * columnsOf(order, term), 0);

/**
 * Decodes the clusters of a set of setsOf; probes have several `outputs`. `view(i)`: the bytes of buffer view i. Throws
 * an Error with the reason for a damaged file.
 */
export function clustersOf(set, view, outputs = 1) {
  const { receivers, order, terms, components, predictors = [], bases, packing } = set;
  const name = nameOf(receivers);
  const predictorRows = 3 * predictors.length;
  let centers = new Int16Array(0);
  if (predictorRows > 0) centers = codedRows(view(set.centers.bufferView), set.centers.drops, components.length, name);
  const dimension = dimensionOf({ order, terms, outputs });
  const firstRows = [];
  let rowCount = 0;
  for (const m of components) {
    firstRows.push(rowCount);
    rowCount += 1 + predictorRows + m;
  }
  const clusters = { order, terms, outputs, components, predictors, centers, firstRows, rowCount };
  const rows = bases.values
    ? decodedRows(clusters, bases, view, name)
    : floats(view(bases.bufferView), rowCount * dimension, LARGEST_TRANSFER, "the bases", name);
  const widths = packing ? packedWidths(set, view) : null;
  return { ...clusters, rows, widths, clusterBits: packing ? packing.clusterBits : 0 };
}

/** Returns the widths, in bits, of the packed weights of each cluster. */
export function packedWidths({ receivers, components, packing }, view) {
  const bytes = view(packing.bufferView);
  let at = 0;
  const next = () => ((bytes[at >> 1] >> (4 * (at++ & 1))) & 15) + 1;
  const widths = components.map((m) => Array.from({ length: m }, next));
  expect(at <= 2 * bytes.length, "the widths of the packed weights end too early", nameOf(receivers));
  return widths;
}

/**
 * Throws if rows of few bytes would need more memory than is allowed for this file size: 256 MB, plus 64
 * bytes per byte.
 */
function checkRows(rows, axes, dimension, bytes, name) {
  const values = rows * (axes + 3 * dimension) + axes * dimension;
  expect(4 * values <= 256e6 + 64 * bytes, `the bases would need ${Math.round((4 * values) / 1e6)} MB`, name);
}

/** Returns the step of each axis in each cluster, [clusters][axes]: one for all, or multiplied by powers of two. */
function stepsOf({ step, steps }, clusterCount, axisCount, view, name) {
  const result = new Float64Array(clusterCount * axisCount).fill(steps ? steps.least : step);
  if (!steps) return result;
  const groupOf = steps.axes.flatMap((count, group) => new Array(count).fill(group));
  const exponents = codedRows(view(steps.bufferView), steps.drops, clusterCount, name);
  for (let k = 0; k < clusterCount; ++k)
    groupOf.forEach((group, i) => {
      result[k * axisCount + i] *= 2 ** exponents[k * steps.axes.length + group];
    });
  return result;
}

/** Returns the rows of coded bases. */
function decodedRows({ order, terms, outputs, components, predictors, firstRows, rowCount }, bases, view, name) {
  const dimension = dimensionOf({ order, terms, outputs });
  const axisCount = bases.values.drops.length;
  expect(bases.axes.drops.length === dimension, "the sizes of the coded bases are inconsistent", name);
  const numbers = ({ bufferView }, count, largest, what) => floats(view(bufferView), count, largest, what, name);
  const origin = numbers(bases.origin, dimension, LARGEST_TRANSFER, "the values of the origin");
  const scales = numbers(bases.scales, axisCount, Number.MAX_VALUE, "the scales");
  const units = bases.units ? numbers(bases.units, dimension, Number.MAX_VALUE, "the units") : new Float32Array(dimension).fill(1);
  const codes = [bases.axes, bases.values].map(({ bufferView }) => view(bufferView));
  checkRows(rowCount, axisCount, dimension, codes[0].length + codes[1].length, name);
  const axes = codedRows(codes[0], bases.axes.drops, axisCount, name);
  const values = codedRows(codes[1], bases.values.drops, rowCount, name);
  const steps = stepsOf(bases, components.length, axisCount, view, name);
  const rows = new Float32Array(rowCount * dimension);
  const row = new Float64Array(dimension);
  components.forEach((m, k) => {
    const firstDirection = firstRows[k] + 1 + 3 * predictors.length;
    for (let r = firstRows[k]; r < firstDirection + m; ++r) {
      const isMean = r === firstRows[k];
      for (let a = 0; a < dimension; ++a) row[a] = isMean ? origin[a] : 0;
      for (let i = 0; i < axisCount; ++i) {
        const value = values[r * axisCount + i];
        if (value === 0) continue;
        const factor = (r < firstDirection ? 1 : 2) * steps[k * axisCount + i] * scales[i] * value;
        for (let a = 0; a < dimension; ++a) row[a] += factor * axes[i * dimension + a] * units[a];
      }
      rows.set(row, r * dimension);
    }
  });
  checkMagnitudes(rows, LARGEST_TRANSFER, "the decoded bases", name);
  return rows;
}

/**
 * Returns the rows that the vertex shader multiplies with its inputs. The value of a predictor is scale x -
 * center: the scale is multiplied into its row, and the center times the row is subtracted from the mean, so
 * that the shader multiplies x. For packed weights w = (2 q - M) / M the factor 2 / M is multiplied into the
 * directions, and their sum is subtracted from the mean, so that the shader multiplies the integers q.
 */
export function shaderRows(clusters) {
  const { predictors, centers, widths, components, firstRows, rows } = clusters;
  const scales = predictors.flatMap(({ scale }) => scale);
  if (!widths && scales.length === 0) return rows;
  const dimension = dimensionOf(clusters);
  const result = new Float32Array(rows);
  components.forEach((m, k) => {
    const mean = firstRows[k] * dimension;
    const sum = Float64Array.from(rows.subarray(mean, mean + dimension));
    const fold = (j, offset, factor) => {
      const row = mean + (1 + j) * dimension;
      for (let a = 0; a < dimension; ++a) {
        sum[a] -= offset * rows[row + a];
        result[row + a] = factor * rows[row + a];
      }
    };
    scales.forEach((scale, g) => fold(g, centers[k * scales.length + g], scale));
    if (widths) widths[k].forEach((width, j) => fold(scales.length + j, 1, 2 / (2 ** width - 1)));
    result.set(sum, mean);
  });
  return result;
}

/** Returns the table of clusters for the shader: first row, components, widths of weights 0..7 and 8..15. */
export function clusterTable(clusters) {
  const { components, firstRows, widths } = clusters;
  const table = new Uint32Array(4 * components.length);
  components.forEach((m, k) => {
    table[4 * k] = firstRows[k];
    table[4 * k + 1] = m;
    if (widths)
      widths[k].forEach((width, j) => {
        table[4 * k + 2 + (j >> 3)] |= (width - 1) << (4 * (j & 7));
      });
  });
  return table;
}

/**
 * Returns the colours that multiply the terms, one after the other, [columns][3]: `sky` [>= order²][3] for
 * direct light, plus `suns` for the other terms (null: all light is in the sky), and `lamps` [lamps][3], the
 * factor of each lamp (null: the strength of the scene).
 */
export function lightColumns({ order, terms }, sky, suns = null, lamps = null) {
  const columns = new Float64Array(3 * terms.reduce((sum, term) => sum + columnsOf(order, term), 0));
  let at = 0;
  let lamp = 0;
  for (const { kind } of terms)
    if (kind === "lamp") {
      for (let c = 0; c < 3; ++c) columns[at++] = lamps ? lamps[3 * lamp + c] : 1;
      ++lamp;
    } else for (let i = 0; i < 3 * order * order; ++i) columns[at++] = sky[i] + (suns && kind !== "direct" ? suns[i] : 0);
  return columns;
}

/**
 * Writes for every row its product with the lighting, RGBA, to `constants` [rows][outputs][4]. `columns`: see
 * lightColumns.
 */
export function updateConstants(clusters, rows, columns, constants) {
  const { order, terms, rowCount, outputs = 1 } = clusters;
  let at = 0;
  for (let r = 0; r < rowCount * outputs; ++r) {
    let red = 0;
    let green = 0;
    let blue = 0;
    let light = 0;
    for (const term of terms) {
      const { channels } = term;
      const count = columnsOf(order, term);
      const [g, b] = channels === 1 ? [at, at] : [at + count, at + 2 * count];
      for (let i = 0; i < count; ++i, light += 3) {
        red += rows[at + i] * columns[light];
        green += rows[g + i] * columns[light + 1];
        blue += rows[b + i] * columns[light + 2];
      }
      at += channels * count;
    }
    constants[4 * r] = red;
    constants[4 * r + 1] = green;
    constants[4 * r + 2] = blue;
  }
  return constants;
}
