// Decoding of PRTKIT_clustered_pca, as docs/format.md says. No three.js here.

import { codedRows } from "./codedRows.js";

/** Bits of a byte array, lowest first. */
class BitReader {
  constructor(bytes) {
    this.bytes = bytes;
    this.position = 0;
  }
  read(width) {
    if (this.position + width > 8 * this.bytes.length) throw new Error("PRTKIT_clustered_pca: the bits end too early");
    let value = 0;
    let taken = 0;
    while (taken < width) {
      const offset = this.position & 7;
      const count = Math.min(8 - offset, width - taken);
      value |= ((this.bytes[this.position >> 3] >> offset) & ((1 << count) - 1)) << taken;
      taken += count;
      this.position += count;
    }
    return value;
  }
}

const floats = (bytes) => new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));

const LAYOUTS = [[], ["direct"], ["indirect"], ["whole"], ["direct", "indirect"]];

const isUnit = (v) => Array.isArray(v) && v.length === 3 && Math.abs(Math.hypot(...v) - 1) <= 1e-3;

function areParts(parts) {
  if (!Array.isArray(parts) || !parts.every((part) => part?.channels === 1 || part?.channels === 3)) return false;
  const skies = parts.filter(({ kind }) => kind !== "lamp");
  const lamps = parts.slice(skies.length);
  const names = lamps.map(({ name }) => name);
  return (
    parts.length > 0 &&
    names.every((name) => typeof name === "string" && name !== "") &&
    new Set(names).size === names.length &&
    lamps.every(({ kind, towards }) => kind === "lamp" && (towards === undefined || isUnit(towards))) &&
    skies.every(({ towards }) => towards === undefined) &&
    LAYOUTS.some((kinds) => kinds.length === skies.length && kinds.every((kind, i) => kind === skies[i].kind))
  );
}

const KINDS = ["normal", "position"];

const areThree = (v) => Array.isArray(v) && v.length === 3 && v.every(Number.isFinite);

/** Whether guides are none, or each kind once at most, normals first. */
function areGuides(guides) {
  if (!Array.isArray(guides)) return false;
  const kinds = guides.map((guide) => KINDS.indexOf(guide?.kind));
  return (
    kinds.every((kind, i) => kind >= 0 && (i === 0 || kind > kinds[i - 1])) &&
    guides.every(
      ({ kind, scale, origin }) => areThree(scale) && scale.every((s) => s !== 0) && (kind === "normal" || areThree(origin)),
    )
  );
}

/** Colours that light a part: the coefficients of a sky, or the one strength of a lamp. */
const columnsOf = (order, { kind }) => (kind === "lamp" ? 1 : order * order);

/** Numbers of a transfer vector: its parts one behind the other, each [channels][columns]. */
const dimensionOf = ({ order, parts }) =>
  parts.reduce((sum, part) => sum + part.channels * columnsOf(order, part), 0);

/**
 * The clusters of a file.
 *
 * `extension`: the object at the top level of the glTF; `view(i)`: the bytes of buffer view i. Throws an Error that says
 * what is wrong with a file that is damaged or of another version.
 */
export function decodeClusters(extension, view) {
  if (extension.version !== 6)
    throw new Error(`PRTKIT_clustered_pca: version ${extension.version} is not known, only 6; compress the model again`);
  const { order, parts, components, guides = [], bases, packing } = extension;
  if (!(order >= 1 && order <= 10) || !areParts(parts) || !Array.isArray(components))
    throw new Error("PRTKIT_clustered_pca: order, parts or components are wrong");
  if (!areGuides(guides)) throw new Error("PRTKIT_clustered_pca: the guides are wrong");
  const guideRows = 3 * guides.length;
  let centers = new Int16Array(0);
  if (guideRows > 0) {
    const { bufferView, drops } = extension.centers;
    if (drops.length !== guideRows) throw new Error("PRTKIT_clustered_pca: the centers are not those of the guides");
    centers = codedRows(view(bufferView), drops, components.length);
  }
  const dimension = dimensionOf({ order, parts });
  const firstRows = [];
  let rowCount = 0;
  for (const m of components) {
    firstRows.push(rowCount);
    rowCount += 1 + guideRows + m;
  }
  let rows;
  if (bases.values) {
    const origin = floats(view(bases.origin.bufferView));
    const scales = floats(view(bases.scales.bufferView));
    const units = bases.units ? floats(view(bases.units.bufferView)) : new Float32Array(dimension).fill(1);
    const axisCount = scales.length;
    if (origin.length !== dimension || units.length !== dimension || bases.axes.drops.length !== dimension || bases.values.drops.length !== axisCount)
      throw new Error("PRTKIT_clustered_pca: the sizes of the coded bases do not fit together");
    const axes = codedRows(view(bases.axes.bufferView), bases.axes.drops, axisCount);
    const values = codedRows(view(bases.values.bufferView), bases.values.drops, rowCount);
    rows = new Float32Array(rowCount * dimension);
    const row = new Float64Array(dimension);
    components.forEach((m, k) => {
      for (let r = firstRows[k]; r <= firstRows[k] + guideRows + m; ++r) {
        const isMean = r === firstRows[k];
        const isDirection = r > firstRows[k] + guideRows;
        for (let a = 0; a < dimension; ++a) row[a] = isMean ? origin[a] : 0;
        for (let i = 0; i < axisCount; ++i) {
          const value = values[r * axisCount + i];
          if (value === 0) continue;
          const factor = (isDirection ? 2 : 1) * bases.step * scales[i] * value;
          for (let a = 0; a < dimension; ++a) row[a] += factor * axes[i * dimension + a] * units[a];
        }
        rows.set(row, r * dimension);
      }
    });
  } else {
    rows = floats(view(bases.bufferView));
    if (rows.length !== rowCount * dimension) throw new Error("PRTKIT_clustered_pca: the bases have another size");
  }
  let widths = null;
  if (packing) {
    const bits = new BitReader(view(packing.bufferView));
    widths = components.map((m) => Array.from({ length: m }, () => bits.read(4) + 1));
  }
  return {
    order,
    parts,
    components,
    guides,
    centers,
    firstRows,
    rowCount,
    rows,
    widths,
    clusterBits: packing ? packing.clusterBits : 0,
  };
}

/**
 * Rows that the vertex shader multiplies with what it reads. A guide counts scale x - center: the scale goes into its row,
 * the center times the row out of the mean, so that the shader multiplies x. For packed weights w = (2 q - M) / M the
 * factor 2 / M goes into the directions, and their sum out of the mean, so that it multiplies the integers q themselves.
 */
export function shaderRows(clusters) {
  const { guides, centers, widths, components, firstRows, rows } = clusters;
  const scales = guides.flatMap(({ scale }) => scale);
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

/** The table that the shader finds clusters in: first row, components, widths of weights 0..7 and 8..15. */
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
 * The colours that the parts are multiplied with, one behind the other, [columns][3]: `sky` [>= order²][3] for direct
 * light, with `suns` added for the rest (null: all light is in the sky), and `lamps` [lamps][3], what each lamp is dimmed
 * or coloured by (null: all shine as in the scene, and keys of a light set, which are not in it, do not).
 */
export function lightColumns({ order, parts }, sky, suns = null, lamps = null) {
  const columns = new Float64Array(3 * parts.reduce((sum, part) => sum + columnsOf(order, part), 0));
  let at = 0;
  let lamp = 0;
  for (const { kind, towards } of parts)
    if (kind === "lamp") {
      for (let c = 0; c < 3; ++c) columns[at++] = lamps ? lamps[3 * lamp + c] : towards ? 0 : 1;
      ++lamp;
    } else for (let i = 0; i < 3 * order * order; ++i) columns[at++] = sky[i] + (suns && kind !== "direct" ? suns[i] : 0);
  return columns;
}

/**
 * Writes for every row its product with the lighting, RGBA, to `constants` [rows][4]. `columns`: of lightColumns.
 */
export function formConstants(clusters, rows, columns, constants) {
  const { order, parts, rowCount } = clusters;
  let at = 0;
  for (let r = 0; r < rowCount; ++r) {
    let red = 0;
    let green = 0;
    let blue = 0;
    let light = 0;
    for (const part of parts) {
      const { channels } = part;
      const count = columnsOf(order, part);
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
