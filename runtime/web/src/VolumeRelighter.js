// Computes incident light of the probes of a volume for the lookup in shaders/prt_volume.glsl, as
// prt::TextureRelighter does. Does not use three.js.

import { updateConstants, shaderRows } from "./clusteredPca.js";
import { halvesOf } from "./halfFloat.js";
import { evaluateSh } from "./sphericalHarmonics.js";
import { BRICK_PROBES } from "./volumeGrid.js";
import { texelOf } from "./volumeTextures.js";

/** Returns the texels of each probe in a plane: [first[p], first[p + 1]). */
function texelsOfProbes({ ofBrick, levels }, atlas) {
  const first = new Uint32Array(levels.length + 1);
  for (const probe of ofBrick) ++first[probe + 1];
  for (let p = 0; p < levels.length; ++p) first[p + 1] += first[p];
  const next = first.slice();
  const texels = new Uint32Array(ofBrick.length);
  ofBrick.forEach((probe, e) => (texels[next[probe]++] = texelOf(atlas, Math.floor(e / BRICK_PROBES), e % BRICK_PROBES)));
  return { first, texels };
}

/**
 * Returns the `direct` transfer of output 0 for light without color, [rowCount][order²]; null without a
 * direct term.
 */
function directRows({ order, terms: [term], rowCount, outputs }, rows) {
  if (term.kind !== "direct") return null;
  const columns = order * order;
  const size = rows.length / (rowCount * outputs);
  const direct = new Float64Array(rowCount * columns);
  for (let r = 0; r < rowCount; ++r)
    for (let c = 0; c < term.channels; ++c)
      for (let i = 0; i < columns; ++i) direct[r * columns + i] += rows[r * outputs * size + c * columns + i] / term.channels;
  return direct;
}

export class VolumeRelighter {
  /** `volume`: see volumeOf (volumeTransfer.js); `atlas`: see atlasOf. */
  constructor({ grid, clusters, words, stride }, atlas) {
    this.clusters = clusters;
    this.words = words;
    this.stride = stride;
    this.atlas = atlas;
    this.rows = shaderRows(clusters);
    this.direct = directRows(clusters, this.rows);
    this.probes = grid.levels.length;
    Object.assign(this, texelsOfProbes(grid, atlas));
    // per row and per probe: colors of the coefficients, the sun, and padding
    this.numbers = 4 * atlas.planes;
    this.constants = new Float64Array(this.numbers * clusters.rowCount);
  }

  /**
   * Computes the constants of the rows of clusters [first, last), for `columns` of lightColumns. `sun`: a
   * unit direction, whose visible fraction is computed in addition to the light; null: no sun.
   */
  updateConstants(columns, sun, first, last) {
    const { clusters, rows, constants, direct, numbers } = this;
    const { order, outputs, firstRows, rowCount } = clusters;
    const [begin, end] = [first, last].map((k) => firstRows[k] ?? rowCount);
    const size = rows.length / rowCount;
    const range = { ...clusters, rowCount: end - begin };
    const colors = updateConstants(range, rows.subarray(begin * size, end * size), columns, new Float64Array(4 * (end - begin) * outputs));
    const basis = sun && direct ? evaluateSh(order, ...sun) : [];
    for (let r = begin; r < end; ++r) {
      for (let o = 0; o < outputs; ++o)
        for (let c = 0; c < 3; ++c) constants[r * numbers + 3 * o + c] = colors[4 * ((r - begin) * outputs + o) + c];
      let seen = 0;
      for (let i = 0; i < basis.length; ++i) seen += direct[r * basis.length + i] * basis[i];
      constants[r * numbers + 3 * outputs] = basis.length > 0 ? seen / basis[0] : 0;
    }
  }

  /** Adds up the numbers of probe `p`. */
  sum(p, sums) {
    const { words, stride, constants, numbers } = this;
    const { components, firstRows, widths, clusterBits } = this.clusters;
    const word = stride * p;
    const cluster = words[word] & (2 ** clusterBits - 1);
    const own = widths[cluster];
    let row = numbers * firstRows[cluster];
    for (let i = 0; i < numbers; ++i) sums[i] = constants[row + i];
    let bit = clusterBits;
    for (let j = 0; j < components[cluster]; ++j) {
      const width = own[j];
      const at = word + (bit >>> 5);
      const shift = bit & 31;
      let weight = words[at] >>> shift;
      if (shift + width > 32) weight |= words[at + 1] << (32 - shift);
      weight &= (1 << width) - 1;
      bit += width;
      row += numbers;
      for (let i = 0; i < numbers; i += 4) {
        sums[i] += weight * constants[row + i];
        sums[i + 1] += weight * constants[row + i + 1];
        sums[i + 2] += weight * constants[row + i + 2];
        sums[i + 3] += weight * constants[row + i + 3];
      }
    }
  }

  /** Writes probes [first, last) to `texels` [planes][texels][4]: floats, or bits of half floats. */
  update(first, last, texels) {
    const { atlas, numbers } = this;
    const sun = 3 * this.clusters.outputs;
    const sums = new Float64Array(numbers);
    const written = new texels.constructor(numbers);
    // Two half floats, or one float, at once.
    const [from, to] = [written, texels].map(({ buffer, byteOffset, byteLength }) => new Uint32Array(buffer, byteOffset, byteLength / 4));
    const texel = from.length / atlas.planes;
    for (let p = first; p < last; ++p) {
      this.sum(p, sums);
      sums[sun] = Math.min(Math.max(sums[sun], 0), 1);
      if (texels instanceof Uint16Array) halvesOf(sums, written);
      else written.set(sums);
      for (let t = this.first[p]; t < this.first[p + 1]; ++t)
        for (let plane = 0; plane < atlas.planes; ++plane) {
          const at = texel * (plane * atlas.texels + this.texels[t]);
          for (let i = 0; i < texel; ++i) to[at + i] = from[texel * plane + i];
        }
    }
  }
}
