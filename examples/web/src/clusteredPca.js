// Decoding of PRTKIT_clustered_pca, as docs/format.md says. No three.js here.

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
  signed(width) {
    const value = this.read(width);
    return width > 0 && value >> (width - 1) ? value - (1 << width) : value;
  }
}

function codedRows(bytes, drops, rows) {
  const bits = new BitReader(bytes);
  const values = new Int16Array(rows * drops.length);
  for (let r = 0; r < rows; ++r) {
    const level = bits.read(4);
    for (let i = 0; i < drops.length; ++i) values[r * drops.length + i] = bits.signed(Math.max(0, level - drops[i]));
  }
  return values;
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
  if (extension.version !== 5)
    throw new Error(`PRTKIT_clustered_pca: version ${extension.version} is not known, only 5; compress the model again`);
  const { order, parts, components, bases, packing } = extension;
  if (!(order >= 1 && order <= 10) || !areParts(parts) || !Array.isArray(components))
    throw new Error("PRTKIT_clustered_pca: order, parts or components are wrong");
  const dimension = dimensionOf({ order, parts });
  const firstRows = [];
  let rowCount = 0;
  for (const m of components) {
    firstRows.push(rowCount);
    rowCount += 1 + m;
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
      for (let r = firstRows[k]; r <= firstRows[k] + m; ++r) {
        const isMean = r === firstRows[k];
        for (let a = 0; a < dimension; ++a) row[a] = isMean ? origin[a] : 0;
        for (let i = 0; i < axisCount; ++i) {
          const value = values[r * axisCount + i];
          if (value === 0) continue;
          const factor = (isMean ? 1 : 2) * bases.step * scales[i] * value;
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
    firstRows,
    rowCount,
    rows,
    widths,
    clusterBits: packing ? packing.clusterBits : 0,
  };
}

/**
 * Rows that the vertex shader multiplies with what it reads: for packed weights w = (2 q - M) / M the factor 2 / M goes
 * into the directions, and their sum out of the mean, so that the shader multiplies the integers q themselves.
 */
export function shaderRows(clusters) {
  const { widths, components, firstRows, rows } = clusters;
  if (!widths) return rows;
  const dimension = dimensionOf(clusters);
  const result = new Float32Array(rows);
  components.forEach((m, k) => {
    const mean = firstRows[k] * dimension;
    for (let j = 0; j < m; ++j) {
      const direction = mean + (1 + j) * dimension;
      const factor = 2 / (2 ** widths[k][j] - 1);
      for (let a = 0; a < dimension; ++a) {
        result[mean + a] -= rows[direction + a];
        result[direction + a] = factor * rows[direction + a];
      }
    }
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
