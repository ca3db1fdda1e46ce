// Real spherical harmonics as in docs/math.md, section 1: orthonormal, Condon-Shortley phase, polar axis z.

export const MAX_ORDER = 10;

const index = (l, m) => l * (l + 1) + m;

/**
 * Returns Q_l^m(z) of docs/math.md, eq. 3: the polynomial in z that multiplies sin^m(theta), normalised;
 * [order²], m >= 0 filled.
 */
function legendre(order, z, out) {
  let product = 1;
  for (let m = 0; m < order; ++m) {
    if (m > 0) product *= (2 * m + 1) / (2 * m);
    const sectoral = (m % 2 === 0 ? 1 : -1) * Math.sqrt(((m > 0 ? 2 : 1) * product) / (4 * Math.PI));
    let previous = 0;
    let current = sectoral;
    out[index(m, m)] = current;
    for (let l = m + 1; l < order; ++l) {
      const a = Math.sqrt((4 * l * l - 1) / (l * l - m * m));
      const b = a * Math.sqrt(((l - 1) ** 2 - m * m) / (4 * (l - 1) ** 2 - 1));
      [previous, current] = [current, a * z * current - (l === m + 1 ? 0 : b * previous)];
      out[index(l, m)] = current;
    }
  }
}

/**
 * Returns the order² basis values in the unit direction (x, y, z).
 */
export function evaluateSh(order, x, y, z, out = new Float64Array(order * order)) {
  legendre(order, z, out);
  let cosine = 1; // sin^m(theta) cos(m phi)
  let sine = 0;
  for (let m = 1; m < order; ++m) {
    [cosine, sine] = [cosine * x - sine * y, cosine * y + sine * x];
    for (let l = m; l < order; ++l) {
      const q = out[index(l, m)];
      out[index(l, m)] = q * cosine;
      out[index(l, -m)] = q * sine;
    }
  }
  return out;
}

/** Returns nodes and weights of Gauss-Legendre quadrature on [-1, 1]. */
export function gaussLegendre(count) {
  const nodes = new Float64Array(count);
  const weights = new Float64Array(count);
  for (let i = 0; i < count; ++i) {
    let x = Math.cos((Math.PI * (i + 0.75)) / (count + 0.5));
    let derivative = 1;
    for (let step = 0; step < 100; ++step) {
      let p = 1;
      let before = 0;
      for (let k = 1; k <= count; ++k) [p, before] = [((2 * k - 1) * x * p - (k - 1) * before) / k, p];
      derivative = (count * (x * p - before)) / (x * x - 1);
      const next = x - p / derivative;
      if (Math.abs(next - x) < 1e-15) break;
      x = next;
    }
    nodes[i] = x;
    weights[i] = 2 / ((1 - x * x) * derivative * derivative);
  }
  return { nodes, weights };
}

/**
 * Returns for each band l the matrix M_ij = ∫ Y_i(w) Y_j(rotation(w)) dw, by an exact quadrature: light of
 * coefficients L is M L in axes that `rotation` maps to those of L. `rotation(x, y, z)`: the direction [3] after a
 * rotation.
 */
function bandMatrices(order, rotation) {
  const rings = gaussLegendre(order);
  const azimuths = 2 * order;
  const matrices = Array.from({ length: order }, (_, l) => new Float64Array((2 * l + 1) ** 2));
  const direct = new Float64Array(order * order);
  const rotated = new Float64Array(order * order);
  for (let r = 0; r < order; ++r)
    for (let a = 0; a < azimuths; ++a) {
      const z = rings.nodes[r];
      const phi = (2 * Math.PI * a) / azimuths;
      const x = Math.sqrt(1 - z * z) * Math.cos(phi);
      const y = Math.sqrt(1 - z * z) * Math.sin(phi);
      const weight = (rings.weights[r] * 2 * Math.PI) / azimuths;
      evaluateSh(order, x, y, z, direct);
      evaluateSh(order, ...rotation(x, y, z), rotated);
      for (let l = 0; l < order; ++l) {
        const size = 2 * l + 1;
        for (let i = 0; i < size; ++i)
          for (let j = 0; j < size; ++j) matrices[l][i * size + j] += weight * direct[l * l + i] * rotated[l * l + j];
      }
    }
  return matrices;
}

/**
 * Returns matrices of bands that convert coefficients about the polar axis +Y, azimuth from +Z to +X, to
 * those about +Z.
 */
export const polarMatrices = (order) => bandMatrices(order, (x, y, z) => [z, x, y]);

/**
 * Returns matrices for `rotatedBands` that convert light in the world to axes that `rotation` maps to the
 * world's, [9] by columns.
 */
export const rotationMatrices = (order, [a, b, c, d, e, f, g, h, k]) =>
  bandMatrices(order, (x, y, z) => [a * x + d * y + g * z, b * x + e * y + h * z, c * x + f * y + k * z]);

/** Returns coefficients [order²][3] rotated by the matrices of all bands. */
export function rotatedBands(matrices, coefficients) {
  const result = new Float64Array(3 * matrices.length ** 2);
  matrices.forEach((matrix, l) => {
    const size = 2 * l + 1;
    const first = 3 * l * l;
    for (let i = 0; i < size; ++i)
      for (let j = 0; j < size; ++j) {
        const factor = matrix[i * size + j];
        for (let c = 0; c < 3; ++c) result[first + 3 * i + c] += factor * coefficients[first + 3 * j + c];
      }
  });
  return result;
}

const matricesByOrder = new Map();

/**
 * Lighting for rotation about +Y: coefficients use that axis as pole, so that a rotation mixes only m with
 * -m.
 */
export class ShLight {
  /** `polar`: [order²][3] about +Y, azimuth from +Z towards +X. */
  constructor(order, polar) {
    this.order = order;
    this.polar = polar;
    if (!matricesByOrder.has(order)) matricesByOrder.set(order, polarMatrices(order));
    this.matrices = matricesByOrder.get(order);
  }

  /** Creates a light from RGB coefficients [order²][3] in prtkit's convention: the inverse of `coefficients`. */
  static fromCoefficients(order, coefficients) {
    const light = new ShLight(order, new Float64Array(3 * order * order));
    for (let l = 0; l < order; ++l) {
      const size = 2 * l + 1;
      for (let i = 0; i < size; ++i)
        for (let j = 0; j < size; ++j) {
          const factor = light.matrices[l][i * size + j]; // orthogonal: the transpose is the inverse
          for (let channel = 0; channel < 3; ++channel)
            light.polar[3 * (l * l + j) + channel] += factor * coefficients[3 * (l * l + i) + channel];
        }
    }
    return light;
  }

  /**
   * Returns RGB coefficients [order²][3] in prtkit's convention, with the light rotated about +Y by `angle`
   * radians: after a quarter rotation, light from +Z comes from +X.
   */
  coefficients(angle = 0) {
    const { order, polar } = this;
    const rotated = new Float64Array(polar);
    for (let l = 1; l < order; ++l)
      for (let m = 1; m <= l; ++m) {
        const c = Math.cos(m * angle);
        const s = Math.sin(m * angle);
        for (let channel = 0; channel < 3; ++channel) {
          const plus = polar[3 * index(l, m) + channel];
          const minus = polar[3 * index(l, -m) + channel];
          rotated[3 * index(l, m) + channel] = c * plus - s * minus;
          rotated[3 * index(l, -m) + channel] = s * plus + c * minus;
        }
      }
    const result = new Float64Array(3 * order * order);
    for (let l = 0; l < order; ++l) {
      const size = 2 * l + 1;
      for (let i = 0; i < size; ++i)
        for (let j = 0; j < size; ++j) {
          const factor = this.matrices[l][i * size + j];
          for (let channel = 0; channel < 3; ++channel)
            result[3 * (l * l + i) + channel] += factor * rotated[3 * (l * l + j) + channel];
        }
    }
    return result;
  }

  /**
   * Returns this light under any rotation or reflection: light from d then comes from `matrix` times d, [9]
   * by columns. Uses a quadrature that is exact for its bands.
   */
  rotated(matrix) {
    const { order } = this;
    const [a, b, c, d, e, f, g, h, k] = matrix;
    const before = this.coefficients();
    const after = new Float64Array(before.length);
    const rings = gaussLegendre(order);
    const basis = new Float64Array(order * order);
    for (let r = 0; r < order; ++r)
      for (let column = 0; column < 2 * order; ++column) {
        const z = rings.nodes[r];
        const phi = (Math.PI * column) / order;
        const [x, y] = [Math.sqrt(1 - z * z) * Math.cos(phi), Math.sqrt(1 - z * z) * Math.sin(phi)];
        const weight = (rings.weights[r] * Math.PI) / order;
        const radiance = [0, 0, 0];
        evaluateSh(order, a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + k * z, basis);
        basis.forEach((value, i) => radiance.forEach((_, rgb) => (radiance[rgb] += weight * value * before[3 * i + rgb])));
        evaluateSh(order, x, y, z, basis);
        basis.forEach((value, i) => radiance.forEach((sum, rgb) => (after[3 * i + rgb] += value * sum)));
      }
    return ShLight.fromCoefficients(order, after);
  }

  /** Returns the sum of this light and `other`, in the bands that both have. */
  plus(other) {
    const order = Math.min(this.order, other.order);
    return new ShLight(order, this.polar.slice(0, 3 * order * order).map((value, i) => value + other.polar[i]));
  }

  /** Returns this light multiplied by a factor. */
  times(factor) {
    return new ShLight(this.order, this.polar.map((value) => factor * value));
  }

  /** Returns the light under the weakest filter that makes its radiance nowhere negative if `deringFactors`. */
  deringed() {
    const factors = deringFactors(this.order, this.polar);
    const band = (i) => Math.floor(Math.sqrt(Math.floor(i / 3) + 0.5));
    return new ShLight(this.order, Float64Array.from(this.polar, (v, i) => v * factors[band(i)]));
  }

  /** Returns the luminance (Rec. 709) of the mean radiance over all directions. */
  meanLuminance() {
    const y00 = 0.5 / Math.sqrt(Math.PI);
    return y00 * (0.2126 * this.polar[0] + 0.7152 * this.polar[1] + 0.0722 * this.polar[2]);
  }
}

/** Azimuth, from +Z towards +X, of the centre of a lat-long image that faces that axis. */
const CENTER_AZIMUTH = { x: Math.PI / 2, z: 0 };

/**
 * Projects a lat-long image: +Y at the top, columns from the centre to the right rotate from +Z towards -X.
 * The image is constant over each texel, and the basis is integrated over it (docs/math.md, eq. 15).
 * `image`: { width, height, data, stride, topFirst, value, center }: numbers per pixel, whether the first row
 * is +Y, a function from a stored number to radiance, and the axis of the centre: "z" as in OpenEXR, "x" as
 * in three.
 */
export function projectLatLong(image, order) {
  const { width, height, data, stride = 4, topFirst = true, value = (v) => v, center = "z" } = image;
  if (!(order >= 1 && order <= MAX_ORDER)) throw new RangeError(`order ${order} is outside 1..${MAX_ORDER}`);
  if (!(center in CENTER_AZIMUTH)) throw new RangeError(`center must be "x" or "z", not "${center}"`);
  const middle = CENTER_AZIMUTH[center];
  // ∫ cos(m phi) and sin(m phi) over the columns, with azimuth decreasing by 2 pi: [2 order - 1][width]
  const columns = Array.from({ length: 2 * order - 1 }, () => new Float64Array(width));
  for (let x = 0; x < width; ++x) {
    const high = middle + 2 * Math.PI * (0.5 - x / width);
    const low = middle + 2 * Math.PI * (0.5 - (x + 1) / width);
    columns[0][x] = high - low;
    for (let m = 1; m < order; ++m) {
      columns[2 * m - 1][x] = (Math.sin(m * high) - Math.sin(m * low)) / m;
      columns[2 * m][x] = (Math.cos(m * low) - Math.cos(m * high)) / m;
    }
  }
  // Trigonometric polynomials of degree order + 1: in small rows four nodes integrate them to rounding.
  const nodes = gaussLegendre(height < 32 ? 20 : 4);
  const polar = new Float64Array(3 * order * order);
  const q = new Float64Array(order * order);
  const rowIntegral = new Float64Array(order * order);
  const pixels = new Float64Array(3 * width);
  const step = Math.PI / height;
  for (let y = 0; y < height; ++y) {
    // ∫ Q_l^m sin^(m+1) over the row
    rowIntegral.fill(0);
    for (let k = 0; k < nodes.nodes.length; ++k) {
      const theta = (y + 0.5 + 0.5 * nodes.nodes[k]) * step;
      const sine = Math.sin(theta);
      legendre(order, Math.cos(theta), q);
      for (let m = 0; m < order; ++m) {
        const weight = 0.5 * step * nodes.weights[k] * sine ** (m + 1);
        for (let l = m; l < order; ++l) rowIntegral[index(l, m)] += weight * q[index(l, m)];
      }
    }
    const start = (topFirst ? y : height - 1 - y) * width * stride;
    for (let x = 0; x < width; ++x)
      for (let channel = 0; channel < 3; ++channel) pixels[3 * x + channel] = value(data[start + x * stride + channel]);
    for (let c = 0; c < 2 * order - 1; ++c) {
      const column = columns[c];
      let red = 0;
      let green = 0;
      let blue = 0;
      for (let x = 0; x < width; ++x) {
        red += column[x] * pixels[3 * x];
        green += column[x] * pixels[3 * x + 1];
        blue += column[x] * pixels[3 * x + 2];
      }
      const m = (c + 1) >> 1;
      const sign = c % 2 === 1 || c === 0 ? 1 : -1;
      for (let l = m; l < order; ++l) {
        const row = rowIntegral[index(l, m)];
        const at = 3 * index(l, sign * m);
        polar[at] += row * red;
        polar[at + 1] += row * green;
        polar[at + 2] += row * blue;
      }
    }
  }
  return new ShLight(order, polar);
}

/**
 * Returns radiance on a grid of `rows` rings of 2 `rows` directions, relative to the channels' means: the
 * minimum, the maximum, and the lowest direction of every patch of the grid in which it is negative.
 */
function radianceOnGrid(order, shares, rows) {
  const columns = 2 * rows;
  const harmonics = new Float64Array(2 * order * columns); // cos(m phi), sin(m phi)
  for (let m = 0; m < order; ++m)
    for (let x = 0; x < columns; ++x) {
      const phi = (Math.PI * (x + 0.5)) / rows;
      harmonics[2 * m * columns + x] = Math.cos(m * phi);
      harmonics[(2 * m + 1) * columns + x] = Math.sin(m * phi);
    }
  const basis = new Float64Array(order * order);
  const values = new Float64Array(columns);
  const lowest = new Float64Array(columns);
  const patch = 16;
  const patches = new Array(Math.ceil(columns / patch));
  const result = { least: Infinity, largest: -Infinity, points: [] };
  for (let y = 0; y < rows; ++y) {
    const theta = (Math.PI * (y + 0.5)) / rows;
    const sine = Math.sin(theta);
    evaluateSh(order, sine, 0, Math.cos(theta), basis); // at azimuth 0: the Legendre factor
    lowest.fill(Infinity);
    for (let channel = 0; channel < 3; ++channel) {
      values.fill(0);
      for (let m = 0; m < order; ++m) {
        let cosine = 0;
        let sines = 0;
        for (let l = m; l < order; ++l) {
          cosine += basis[index(l, m)] * shares[3 * index(l, m) + channel];
          if (m > 0) sines += basis[index(l, m)] * shares[3 * index(l, -m) + channel];
        }
        for (let x = 0, at = 2 * m * columns; x < columns; ++x)
          values[x] += cosine * harmonics[at + x] + sines * harmonics[at + columns + x];
      }
      for (let x = 0; x < columns; ++x) {
        if (values[x] < lowest[x]) lowest[x] = values[x];
        if (values[x] > result.largest) result.largest = values[x];
      }
    }
    for (let x = 0; x < columns; ++x) {
      if (lowest[x] < result.least) result.least = lowest[x];
      const best = patches[(x / patch) | 0];
      if (lowest[x] < (best ? best.value : 0)) {
        const phi = (Math.PI * (x + 0.5)) / rows;
        const direction = [sine * Math.cos(phi), sine * Math.sin(phi), Math.cos(theta)];
        patches[(x / patch) | 0] = { value: lowest[x], direction };
      }
    }
    if ((y + 1) % patch === 0 || y + 1 === rows) {
      for (const point of patches) if (point) result.points.push(point);
      patches.fill(undefined);
    }
  }
  return result;
}

/**
 * Solves the symmetric system `matrix` x = `right` by Cholesky's method; linearly dependent rows have little
 * effect.
 */
function solveSymmetric(matrix, right) {
  const n = right.length;
  const l = matrix.map((row) => Float64Array.from(row));
  const x = Float64Array.from(right);
  for (let i = 0; i < n; ++i)
    for (let j = 0; j <= i; ++j) {
      let sum = matrix[i][j] * (i === j ? 1 + 1e-10 : 1);
      for (let k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = i === j ? Math.sqrt(Math.max(sum, 1e-12 * matrix[i][i])) : sum / l[j][j];
    }
  for (let i = 0; i < n; ++i) {
    for (let k = 0; k < i; ++k) x[i] -= l[i][k] * x[k];
    x[i] /= l[i][i];
  }
  for (let i = n - 1; i >= 0; --i) {
    for (let k = i + 1; k < n; ++k) x[i] -= l[k][i] * x[k];
    x[i] /= l[i][i];
  }
  return x;
}

/**
 * Returns the factors h that minimise sum weights[l] (1 - h[l])², l > 0, with row[0] + sum h[l] row[l] >= 0 for all `rows`, by the
 * active-set method of Lawson and Hanson on the dual.
 */
function leastChange(order, weights, rows, tolerance) {
  const bands = Array.from({ length: order - 1 }, (_, l) => l + 1);
  const value = (row, h) => bands.reduce((sum, l) => sum + h[l] * row[l], row[0]);
  const ones = new Float64Array(order).fill(1);
  let active = [];
  let multipliers = [];
  let h = ones;
  for (let step = 0; step < 500; ++step) {
    let worst = rows[0];
    for (const row of rows) if (value(row, h) < value(worst, h)) worst = row;
    if (value(worst, h) >= -tolerance || active.includes(worst)) break;
    active.push(worst);
    multipliers.push(0);
    while (active.length > 0) {
      const matrix = active.map((a) => active.map((b) => bands.reduce((sum, l) => sum + (a[l] * b[l]) / weights[l], 0)));
      const goal = solveSymmetric(matrix, active.map((row) => -value(row, ones)));
      let share = 1;
      let leaving = -1;
      goal.forEach((g, k) => {
        if (g > 0) return;
        const reach = multipliers[k] / (multipliers[k] - g);
        if (!(reach >= share)) [share, leaving] = [reach, k];
      });
      multipliers = multipliers.map((m, k) => m + share * (goal[k] - m));
      if (leaving < 0) break;
      active = active.filter((_, k) => k !== leaving);
      multipliers = multipliers.filter((_, k) => k !== leaving);
    }
    h = Float64Array.from(ones);
    active.forEach((row, k) => bands.forEach((l) => (h[l] += (multipliers[k] * row[l]) / weights[l])));
  }
  return h.map((factor) => Math.min(Math.max(factor, 0), 1));
}

/**
 * Returns the mean radiance of a channel; 0 if it is not positive, or less than a millionth of a coefficient:
 * light that is nowhere negative has no larger coefficients, and relative values would be rounding errors and
 * overflow.
 */
function usableMean(coefficients, channel) {
  let largest = 0;
  for (let i = channel; i < coefficients.length; i += 3) largest = Math.max(largest, Math.abs(coefficients[i]));
  const first = coefficients[channel];
  return first > 0 && first >= 1e-6 * largest ? (first * 0.5) / Math.sqrt(Math.PI) : 0;
}

/**
 * Returns the factors of the bands [order] that make a light nowhere negative in any channel with the minimum
 * change of light on receivers: docs/math.md, eq. 16 to 19. `coefficients`: [order²][3], about any axis. 1 if
 * the light is nowhere negative. The factors do not depend on the rotation of the light.
 */
export function deringFactors(order, coefficients) {
  const slack = 0.01; // relative to the mean; the remainder is removed by reducing contrast
  const between = (rows) => {
    const drop = (((order - 1) * Math.PI) / rows) ** 2 / 8;
    return drop / (1 - 2 * drop) + 1e-9;
  };
  const rowsFor = (share) => {
    const rows = ((order - 1) * Math.PI) / Math.sqrt((8 * share) / (1 + 2 * share));
    return Math.max(16, 16 * Math.ceil(rows / 16));
  };
  const mean = [0, 1, 2].map((channel) => usableMean(coefficients, channel));
  const shares = Float64Array.from(coefficients, (v, i) => (mean[i % 3] > 0 ? v / mean[i % 3] : 0));
  shares.fill(Math.sqrt(4 * Math.PI), 0, 3); // a channel without a mean counts as 1 everywhere
  const weights = new Float64Array(order);
  for (let i = 3; i < coefficients.length; ++i) {
    const l = Math.floor(Math.sqrt(Math.floor(i / 3) + 0.5));
    weights[l] += coefficients[i] ** 2 / l ** 2;
  }
  const total = weights.reduce((sum, w) => sum + w, 0);
  for (let l = 1; l < order; ++l) weights[l] = Math.max(weights[l], 1e-12 * total);

  const constraints = [];
  for (let l = 1; l < order; ++l) {
    const band = new Float64Array(order);
    band[l] = 1;
    constraints.push(band, Float64Array.from(band, (v, i) => (i === 0 ? 1 : -v))); // 0 <= h <= 1
  }
  const addDirections = (points) => {
    for (const { direction } of points) {
      const basis = evaluateSh(order, ...direction);
      for (let channel = 0; channel < 3; ++channel) {
        if (!(mean[channel] > 0)) continue;
        const row = new Float64Array(order);
        row[0] = 1;
        for (let l = 1; l < order; ++l)
          for (let i = l * l; i < (l + 1) ** 2; ++i) row[l] += basis[i] * shares[3 * i + channel];
        if (row.reduce((sum, v, l) => sum + (l > 0 ? Math.min(v, 0) : v), 0) < 0) constraints.push(row);
      }
    }
  };

  let factors = new Float64Array(order).fill(1);
  let rows = rowsFor(0.05);
  let lower = 0;
  for (let round = 0; round < 10; ++round) {
    const filtered = shares.map((v, i) => v * factors[Math.floor(Math.sqrt(Math.floor(i / 3) + 0.5))]);
    const grid = radianceOnGrid(order, filtered, rows);
    const range = grid.largest - grid.least;
    lower = grid.least - between(rows) * range;
    if (lower >= 0) break;
    if (grid.least < -slack) {
      addDirections(grid.points);
      factors = leastChange(order, weights, constraints, 0.1 * slack);
      continue;
    }
    const enough = rowsFor(Math.max(grid.least, slack) / range);
    if (enough <= rows) break;
    rows = enough;
  }
  return factors.map((factor, l) => (l === 0 ? 1 : factor / (1 - Math.min(lower, 0))));
}
