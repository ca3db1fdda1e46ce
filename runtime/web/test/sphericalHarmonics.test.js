// Tests spherical harmonics, projection and windows.

import assert from "node:assert/strict";
import { test } from "node:test";
import { deringFactors, evaluateSh, gaussLegendre, projectLatLong, ShLight } from "../src/sphericalHarmonics.js";

const near = (actual, expected, tolerance, what = "") =>
  assert.ok(Math.abs(actual - expected) <= tolerance, `${what} ${actual} is not within ${tolerance} of ${expected}`);

const unit = (v) => v.map((x) => x / Math.hypot(...v));

/** Calls `sum` with directions and weights of a quadrature over the sphere that is exact for degree 2 n - 1. */
function overSphere(n, sum) {
  const { nodes, weights } = gaussLegendre(n);
  for (let r = 0; r < n; ++r)
    for (let a = 0; a < 2 * n; ++a) {
      const phi = (Math.PI * (a + 0.5)) / n;
      const s = Math.sqrt(1 - nodes[r] ** 2);
      sum([s * Math.cos(phi), s * Math.sin(phi), nodes[r]], (weights[r] * Math.PI) / n);
    }
}

/** A lat-long image of `radiance(direction)`, taken at the centres of texels. */
function imageOf(width, height, radiance) {
  const data = new Float32Array(4 * width * height);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const phi = 2 * Math.PI * (0.5 - (x + 0.5) / width);
      const theta = (Math.PI * (y + 0.5)) / height;
      const d = [Math.sin(theta) * Math.sin(phi), Math.cos(theta), Math.sin(theta) * Math.cos(phi)];
      data.set([...radiance(d), 1], 4 * (y * width + x));
    }
  return { width, height, data };
}

test("the first basis functions follow the convention", () => {
  const d = [0.36, -0.48, 0.8];
  const y = evaluateSh(3, ...d);
  near(y[0], 0.282094791774, 1e-9);
  near(y[1], -0.488602511903 * d[1], 1e-9);
  near(y[2], 0.488602511903 * d[2], 1e-9);
  near(y[3], -0.488602511903 * d[0], 1e-9);
  near(y[4], 1.092548430592 * d[0] * d[1], 1e-9);
  near(y[6], 0.315391565253 * (3 * d[2] ** 2 - 1), 1e-9);
  near(y[8], 0.546274215296 * (d[0] ** 2 - d[1] ** 2), 1e-9);
});

test("the basis is orthonormal in every order", () => {
  const order = 10;
  const products = new Float64Array(order ** 4);
  overSphere(order, (d, weight) => {
    const y = evaluateSh(order, ...d);
    for (let i = 0; i < y.length; ++i) for (let j = 0; j < y.length; ++j) products[i * y.length + j] += weight * y[i] * y[j];
  });
  for (let i = 0; i < 100; ++i) for (let j = 0; j < 100; ++j) near(products[100 * i + j], i === j ? 1 : 0, 1e-12);
});

test("an image of one pixel is a constant light", () => {
  const light = projectLatLong({ width: 1, height: 1, data: [3, 2, 1, 1] }, 6);
  const c = light.coefficients();
  near(c[0], 3 * Math.sqrt(4 * Math.PI), 1e-5);
  for (let i = 3; i < c.length; ++i) near(c[i], 0, 1e-6);
  near(light.meanLuminance(), 3 * 0.2126 + 2 * 0.7152 + 0.0722, 1e-6);
});

test("light from a direction comes from that direction", () => {
  // Linear in x, y and z: only bands 0 and 1, in closed form.
  const light = projectLatLong(
    imageOf(256, 128, ([x, y, z]) => [1 + x, 1 + y, 1 + z]),
    4,
  );
  const c = light.coefficients();
  const first = Math.sqrt((4 * Math.PI) / 3);
  // Y_1-1 ~ -y, Y_10 ~ z, Y_11 ~ -x; texels of 1.4 degrees.
  near(c[3 * 3], -first, 1e-3, "x");
  near(c[3 * 1 + 1], -first, 1e-3, "y");
  near(c[3 * 2 + 2], first, 1e-3, "z");
  near(c[3 * 1], 0, 1e-6);
  near(c[3 * 2 + 1], 0, 1e-6);
  for (let i = 12; i < c.length; ++i) near(c[i], 0, 1e-3);
});

test("a rotated light equals the light of the rotated image", () => {
  const sky = ([x, y, z]) => [Math.exp(2 * x - y), Math.exp(z + 0.5 * x * y), Math.max(0, y)];
  const angle = 1.234;
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const rotated = projectLatLong(imageOf(512, 256, sky), 8).coefficients(angle);
  // f'(w) = f(R^-1 w)
  const expected = projectLatLong(
    imageOf(512, 256, ([x, y, z]) => sky([c * x - s * z, y, s * x + c * z])),
    8,
  ).coefficients();
  expected.forEach((value, i) => near(rotated[i], value, 2e-3, `coefficient ${i}`));
});

test("a quarter rotation moves light from +Z to +X", () => {
  const light = projectLatLong(imageOf(64, 32, ([, , z]) => [z > 0.9 ? 1 : 0, 0, 0]), 3);
  const c = light.coefficients(Math.PI / 2);
  assert.ok(-c[9] > 0.1, "light from +X");
  near(c[6], 0, 1e-6);
});

test("rows may start at the bottom", () => {
  const image = imageOf(16, 8, ([x, y]) => [1 + y, x + 2, 0.5]);
  const flipped = new Float32Array(image.data.length);
  for (let y = 0; y < 8; ++y) flipped.set(image.data.subarray(64 * y, 64 * (y + 1)), 64 * (7 - y));
  assert.deepEqual(projectLatLong({ ...image, data: flipped, topFirst: false }, 4).polar, projectLatLong(image, 4).polar);
});

test("orders outside 1..10 are rejected", () => {
  const white = imageOf(2, 1, () => [1, 1, 1]);
  for (const order of [0, 11, NaN]) assert.throws(() => projectLatLong(white, order), RangeError);
  for (const order of [1, 10]) assert.equal(projectLatLong(white, order).coefficients().length, 3 * order ** 2);
});

test("conversion to coefficients keeps the light", () => {
  const light = new ShLight(2, Float64Array.from({ length: 12 }, (_, i) => i));
  const before = [...light.polar];
  light.coefficients(1);
  assert.deepEqual([...light.polar], before);
});

/** A directional sun of `order` bands over a sky of constant radiance. */
function sunAndSky(order, towards, sky) {
  const basis = evaluateSh(order, ...towards);
  const coefficients = new Float64Array(3 * order * order);
  basis.forEach((y, i) => coefficients.set([3 * y, 2.5 * y, 2 * y], 3 * i));
  for (let c = 0; c < 3; ++c) coefficients[c] += sky[c] * Math.sqrt(4 * Math.PI);
  return coefficients;
}

/**
 * Returns the minimum radiance of any channel under these factors, over directions independent of the
 * filter's grid.
 */
function leastRadiance(order, coefficients, factors) {
  const light = coefficients.map((v, i) => v * factors[Math.floor(Math.sqrt(Math.floor(i / 3) + 0.5))]);
  let least = Infinity;
  const count = 20000; // a Fibonacci lattice
  for (let k = 0; k < count; ++k) {
    const z = 1 - (2 * k + 1) / count;
    const phi = 2 * Math.PI * 0.6180339887498949 * k;
    const basis = evaluateSh(order, Math.sqrt(1 - z * z) * Math.cos(phi), Math.sqrt(1 - z * z) * Math.sin(phi), z);
    for (let c = 0; c < 3; ++c) least = Math.min(least, basis.reduce((sum, y, i) => sum + y * light[3 * i + c], 0));
  }
  return least;
}

test("a deringed sun is nowhere negative and keeps its energy and most of its contrast", () => {
  for (const order of [2, 3, 6, 10]) {
    const raw = sunAndSky(order, [0.48, 0.6, -0.64], [0.1, 0.1, 0.2]);
    const factors = deringFactors(order, raw);
    assert.equal(factors[0], 1);
    const least = leastRadiance(order, raw, factors);
    assert.ok(least >= 0, `order ${order}: ${least}`);
    if (order === 6) for (const [l, kept] of [0.9, 0.7, 0.45, 0.25, 0.1].entries()) assert.ok(factors[l + 1] > kept);
  }
});

test("light that is nowhere negative is unchanged", () => {
  const light = projectLatLong(imageOf(32, 16, (d) => [2 + d[0], 2, 2 + d[1]]), 5);
  assert.deepEqual(light.deringed().coefficients(0.4), light.coefficients(0.4));
});

test("rotation of the light does not change the factors", () => {
  const order = 6;
  const straight = deringFactors(order, sunAndSky(order, [0, 0, 1], [0.1, 0.1, 0.2]));
  for (let k = 0; k < 12; ++k) {
    const z = 1 - (2 * k + 1) / 12;
    const towards = [Math.sqrt(1 - z * z) * Math.cos(2.4 * k), Math.sqrt(1 - z * z) * Math.sin(2.4 * k), z];
    const rotated = deringFactors(order, sunAndSky(order, towards, [0.1, 0.1, 0.2]));
    rotated.forEach((factor, l) => near(factor, straight[l], 0.03, `${towards}, band ${l}:`));
  }
});

test("light of one band and its mean is dimmed until its darkest direction is black", () => {
  // Four times the Legendre polynomials P_1, which falls to -1, and P_2, which falls to -1/2, about a mean of 1.
  for (const [band, darkest] of [[1, -1], [2, -0.5]]) {
    const light = new Float64Array(27).fill(Math.sqrt(4 * Math.PI), 0, 3);
    const polar = 3 * band * (band + 1);
    light.fill(4 * Math.sqrt((4 * Math.PI) / (2 * band + 1)), polar, polar + 3);
    const factors = deringFactors(3, light);
    for (let l = 1; l < 3; ++l) near(factors[l], l === band ? -1 / (4 * darkest) : 1, 0.02, `band ${l} of ${band}`);
  }
});

test("light with a tiny mean becomes nonnegative, and deringing ends", () => {
  const light = Float64Array.from({ length: 108 }, (_, i) => (i < 3 ? 1 : 100 * Math.sin(i * i)));
  const least = leastRadiance(6, light, deringFactors(6, light));
  assert.ok(least >= 0, `${least}`);
});

test("a channel with a negligible mean is excluded from deringing", () => {
  const sun = sunAndSky(3, [0.48, 0.6, -0.64], [0.1, 0.1, 0.1]);
  const white = sun.map((_, i) => sun[i - (i % 3)]);
  const factors = deringFactors(3, white);
  for (const mean of [0, 1e-320, 1e-7, -1, NaN]) {
    const odd = white.map((v, i) => (i === 0 ? mean : v));
    assert.deepEqual(deringFactors(3, odd), factors, `${mean}`);
  }
});

test("a rotated light has rotated directions for every rotation", () => {
  const [a, b, c] = [unit([1, 2, -2]), unit([2, 1, 2]), unit([-2, 2, 1])]; // columns
  for (const matrix of [[...a, ...b, ...c], [...a, ...b, ...c.map((value) => -value)]]) {
    const light = new ShLight(7, Float64Array.from({ length: 147 }, (_, i) => Math.sin(i * i)));
    const [before, after] = [light.coefficients(), light.rotated(matrix).coefficients()];
    const radiance = (coefficients, d) => evaluateSh(7, ...d).reduce((sum, y, i) => sum + y * coefficients[3 * i + 1], 0);
    for (const d of [[0.36, -0.48, 0.8], [0, 0, -1], [-0.6, 0, 0.8]]) {
      const rotated = [0, 1, 2].map((row) => matrix[row] * d[0] + matrix[3 + row] * d[1] + matrix[6 + row] * d[2]);
      near(radiance(after, rotated), radiance(before, d), 1e-12);
    }
  }
});

test("a rotation about +Y by matrix equals that by angle", () => {
  const light = new ShLight(4, Float64Array.from({ length: 48 }, (_, i) => Math.cos(i * i)));
  const [cosine, sine] = [Math.cos(0.7), Math.sin(0.7)];
  const rotated = light.rotated([cosine, 0, -sine, 0, 1, 0, sine, 0, cosine]).coefficients();
  light.coefficients(0.7).forEach((value, i) => near(rotated[i], value, 1e-12));
});
