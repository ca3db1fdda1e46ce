// Computes constants of instances that share the transfer of their mesh, which their shader reads instead of
// those of the model (shaders/prt_instances.glsl), like prt::InstanceRelighter. They are linear in the
// position within the box of the mesh, so that a row needs three vectors, not one. Does not use three.js.

import { updateConstants, lightColumns } from "./clusteredPca.js";
import { ADDED_BANDS, ADDED_MODES, LAMP_FUNCTIONS, LAMP_NUMBERS, InstanceModes, instanceRotations, PASSING_MODES, responsesOf } from "./instanceModes.js";
import { rotationMatrices, rotatedBands } from "./sphericalHarmonics.js";
import { updateAtYaw, polarRows, rotationTerms, seriesSize, yawSeries } from "./yawHarmonics.js";

/** Number of rotations about +Y for which light is computed: at most 0.7 degrees off. */
const YAWS = 256;

/**
 * Returns the rows of the clusters that a mesh uses, in their order, and the first of these rows for each
 * cluster. `numbers`: the clusters of its vertices.
 */
export function rowsOf({ components, firstRows, rowCount }, numbers) {
  const used = new Set(numbers);
  const list = [];
  const begins = components.map((_, k) => {
    const begin = list.length;
    if (used.has(k)) for (let row = firstRows[k]; row < (firstRows[k + 1] ?? rowCount); ++row) list.push(row);
    return begin;
  });
  return { list: Uint32Array.from(list), begins };
}

/**
 * Writes the constants of an instance for its rows: `factors` as in files, `added` [ADDED_MODES][3] the
 * reflected modes of its light, in the axes of the mesh. Unrolled over the transmitted modes, because most of
 * the time is spent here.
 */
function writeRows(constants, at, rows, modes, responses, factors, added) {
  const [a, b, c, d, e, f, g, h, i, j] = modes;
  const p = factors;
  for (let n = 0, to = at; n < rows.length; ++n) {
    const row = rows[n];
    const response = 3 * ADDED_MODES * row;
    for (let color = 0; color < 3; ++color, to += 4) {
      const from = 4 * row + color;
      const m0 = a[from];
      const m1 = b[from];
      const m2 = c[from];
      const m3 = d[from];
      const m4 = e[from];
      const m5 = f[from];
      const m6 = g[from];
      const m7 = h[from];
      const m8 = i[from];
      const m9 = j[from];
      constants[to] =
        p[0] * m0 + p[4] * m1 + p[8] * m2 + p[12] * m3 + p[16] * m4 +
        p[20] * m5 + p[24] * m6 + p[28] * m7 + p[32] * m8 + p[36] * m9;
      constants[to + 1] =
        p[1] * m0 + p[5] * m1 + p[9] * m2 + p[13] * m3 + p[17] * m4 +
        p[21] * m5 + p[25] * m6 + p[29] * m7 + p[33] * m8 + p[37] * m9;
      constants[to + 2] =
        p[2] * m0 + p[6] * m1 + p[10] * m2 + p[14] * m3 + p[18] * m4 +
        p[22] * m5 + p[26] * m6 + p[30] * m7 + p[34] * m8 + p[38] * m9;
      constants[to + 3] =
        p[3] * m0 + p[7] * m1 + p[11] * m2 + p[15] * m3 + p[19] * m4 +
        p[23] * m5 + p[27] * m6 + p[31] * m7 + p[35] * m8 + p[39] * m9 +
        added[color] * responses[response + color] +
        added[3 + color] * responses[response + 3 + color] +
        added[6 + color] * responses[response + 6 + color] +
        added[9 + color] * responses[response + 9 + color];
    }
  }
}

/** Returns clusters and rows without the columns of lamps, which have their own light at instances. */
function distantLight(clusters, rows) {
  const terms = clusters.terms.filter(({ kind }) => kind !== "lamp");
  if (terms.length === clusters.terms.length) return { clusters, rows };
  const size = rows.length / clusters.rowCount;
  const kept = clusters.order ** 2 * terms.reduce((sum, { channels }) => sum + channels, 0);
  const distant = new rows.constructor(kept * clusters.rowCount);
  for (let r = 0; r < clusters.rowCount; ++r) distant.set(rows.subarray(r * size, r * size + kept), r * kept);
  return { clusters: { ...clusters, terms }, rows: distant };
}

/** Returns the light of all lamps together, [LAMP_FUNCTIONS][3][4]; `strengths` [lamps][3]: see lightColumns. */
function sumOfLamps(lamps, strengths) {
  const sum = new Float64Array(LAMP_NUMBERS);
  for (let first = 0, lamp = 0; first < lamps.length; first += LAMP_NUMBERS, ++lamp)
    for (let j = 0; j < LAMP_NUMBERS; ++j) sum[j] += (strengths ? strengths[3 * lamp + ((j >> 2) % 3)] : 1) * lamps[first + j];
  return sum;
}

/** Adds the light of lamps (sumOfLamps) to the constants of an instance; `responses`: see responsesOf. */
function addLamps(constants, at, rows, responses, light) {
  for (let n = 0, to = at; n < rows.length; ++n)
    for (let color = 0; color < 3; ++color, to += 4)
      for (let i = 0; i < LAMP_FUNCTIONS; ++i) {
        const response = responses[3 * (LAMP_FUNCTIONS * rows[n] + i) + color];
        for (let a = 0; a < 4; ++a) constants[to + a] += response * light[12 * i + 4 * color + a];
      }
}

/** Returns the light that an instance adds, given the light on level ground, [ADDED_MODES][3] in world axes. */
function addedBy(factors, onLevel) {
  return Float64Array.from({ length: 3 * ADDED_MODES }, (_, i) => factors[4 * PASSING_MODES + i] * onLevel[i % 3]);
}

export class InstanceRelighter {
  /**
   * `rows`: see shaderRows. `instances`: { factors, lamps, rotation, box, rows } of each: its factors as in
   * files; the light of lamps of lampLightOf, if the transfer has lamps; rotation from the space of the mesh to
   * the world, [9] by columns; the box of the mesh; the list of rowsOf.
   */
  constructor(allClusters, allRows, instances, yaws = YAWS) {
    const { clusters, rows } = distantLight(allClusters, allRows);
    this.clusters = clusters;
    this.rows = rows;
    this.lampResponses = allClusters === clusters ? null : responsesOf(clusters, rows, LAMP_FUNCTIONS);
    this.instances = instances;
    this.modes = new InstanceModes(clusters.order);
    this.responses = responsesOf(clusters, rows);
    this.constantsOfModes = Array.from({ length: PASSING_MODES }, () => new Float64Array(4 * clusters.rowCount));
    const { order, rowCount } = clusters;
    const found = instanceRotations(instances.map(({ rotation }) => rotation), yaws);
    this.rotations = found.rotations.map((rotation, t) => {
      const yaw = found.yaws[t];
      const bands = rotationMatrices(ADDED_BANDS, rotation);
      return { rotation, bands, instances: [], terms: yaw === null ? null : rotationTerms(order, yaw) };
    });
    const isUpright = this.rotations.some(({ terms }) => terms);
    this.polarRows = isUpright ? polarRows(clusters, rows) : null;
    this.series = this.constantsOfModes.map(() => (isUpright ? new Float64Array(3 * seriesSize(order) * rowCount) : null));
    found.of.forEach((rotation, i) => this.rotations[rotation].instances.push(i));
    /** First constant of each instance, and total size, in vectors of four. */
    this.begins = new Float64Array(instances.length);
    this.size = 0;
    instances.forEach(({ rows: { length } }, i) => {
      this.begins[i] = this.size;
      this.size += 3 * length;
    });
  }

  /** Returns the attributes of instances [first, first + count): the center of the box and one over its half widths; in w the
   * index of the first constant, 16 bits in each. */
  table(first, count) {
    const [low, high] = [new Float32Array(4 * count), new Float32Array(4 * count)];
    for (let i = 0; i < count; ++i) {
      const { middle, half } = this.instances[first + i].box;
      const offset = this.begins[first + i] / 3;
      low.set([...middle, offset & 0xffff], 4 * i);
      high.set([...half.map((width) => 1 / width), offset >>> 16], 4 * i);
    }
    return [low, high];
  }

  /**
   * Computes the constants of the transmitted modes under `skies` and, if there are any, `suns`, for the rows
   * that a rotation uses.
   */
  updateModes({ rotation, terms, instances }, skies, suns) {
    const { clusters, rows } = this;
    let [first, end] = [Infinity, 0];
    for (const i of instances) {
      const used = this.instances[i].rows;
      if (used.length === 0) continue;
      first = Math.min(first, used[0]);
      end = Math.max(end, used[used.length - 1] + 1);
    }
    if (!(first < end)) return;
    if (terms) return this.constantsOfModes.forEach((constants, m) => updateAtYaw(this.series[m], terms, first, end, constants));
    const matrices = rotationMatrices(clusters.order, rotation);
    const size = rows.length / clusters.rowCount;
    const range = { ...clusters, rowCount: end - first };
    this.constantsOfModes.forEach((constants, m) => {
      const columns = lightColumns(clusters, rotatedBands(matrices, skies[m]), suns ? rotatedBands(matrices, suns[m]) : null);
      updateConstants(range, rows.subarray(first * size, end * size), columns, constants.subarray(4 * first, 4 * end));
    });
  }

  /**
   * Writes the constants of all instances, [size][4], under coefficients [order²][3] in world axes; `suns` and
   * `strengths` of lamps: see lightColumns.
   */
  update(sky, suns, strengths, constants) {
    const skies = this.modes.passing(sky);
    const passed = suns ? this.modes.passing(suns) : null;
    const onLevel = this.modes.onLevel(suns ? sky.map((value, i) => value + suns[i]) : sky);
    const both = passed?.map((light, m) => light.map((value, i) => value + skies[m][i])) ?? skies;
    if (this.polarRows) this.series.forEach((series, m) => yawSeries(this.clusters, this.polarRows, skies[m], both[m], series));
    for (const rotation of this.rotations) {
      this.updateModes(rotation, skies, passed);
      for (const i of rotation.instances) {
        const { factors, lamps, rows } = this.instances[i];
        const added = rotatedBands(rotation.bands, addedBy(factors, onLevel));
        writeRows(constants, 4 * this.begins[i], rows, this.constantsOfModes, this.responses, factors, added);
        if (this.lampResponses) addLamps(constants, 4 * this.begins[i], rows, this.lampResponses, sumOfLamps(lamps, strengths));
      }
    }
    return constants;
  }
}
