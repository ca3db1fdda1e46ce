// Tests the reader of light files.

import assert from "node:assert/strict";
import { test } from "node:test";
import { lightOfSuns, readLightFile } from "../src/lightFile.js";
import { evaluateSh, gaussLegendre } from "../src/sphericalHarmonics.js";

const near = (actual, expected, tolerance, what = "") =>
  assert.ok(Math.abs(actual - expected) <= tolerance, `${what} ${actual} is not within ${tolerance} of ${expected}`);

const numbers = (count, from) => Array.from({ length: count }, (_, i) => from + i);
const file = (changes = {}) => ({
  prtkit_light: 1,
  order: 3,
  coefficients: { red: numbers(9, 1), green: numbers(9, -4), blue: numbers(9, 0.5) },
  suns: [{ towards: [0, 2, 0], irradiance: [3, 2.5, 2], half_angle_radians: 0.01, energy_share: 0.4 }],
  ...changes,
});

test("a light file contains the coefficients of its sky", () => {
  const { sky, suns } = readLightFile(file());
  assert.equal(sky.order, 3);
  sky.coefficients().forEach((value, i) => near(value, [1, -4, 0.5][i % 3] + Math.floor(i / 3), 1e-12, `coefficient ${i}`));
  assert.deepEqual(suns, [{ towards: [0, 1, 0], irradiance: [3, 2.5, 2], halfAngle: 0.01 }]);
  assert.deepEqual(readLightFile(file({ suns: undefined })).suns, []);
});

test("invalid light files are rejected", () => {
  const sun = file().suns[0];
  const bad = [
    null,
    {},
    file({ prtkit_light: 2 }),
    file({ lights: [] }),
    file({ order: 11 }),
    file({ order: 2.5 }),
    file({ order: 4 }),
    file({ coefficients: undefined }),
    file({ coefficients: { ...file().coefficients, blue: [...numbers(8, 0), null] } }),
    file({ suns: {} }),
    file({ suns: [{ ...sun, towards: [0, 0, 0] }] }),
    file({ suns: [{ ...sun, towards: [1, 0] }] }),
    file({ suns: [{ ...sun, irradiance: [1, -1, 1] }] }),
    file({ suns: [{ ...sun, irradiance: [1, NaN, 1] }] }),
    file({ suns: [{ ...sun, half_angle_radians: 2 }] }),
    file({ suns: [{ ...sun, half_angle_radians: undefined }] }),
  ];
  for (const json of bad) assert.throws(() => readLightFile(json), /^Error: light file: /);
});

/** ∫ Y over a cap about `towards`, by quadrature in its own frame. */
function capIntegral(order, [x, y, z], halfAngle) {
  const tangent = Math.abs(y) < 0.9 ? [z, 0, -x] : [0, -z, y];
  const length = Math.hypot(...tangent);
  const t = tangent.map((value) => value / length);
  const b = [y * t[2] - z * t[1], z * t[0] - x * t[2], x * t[1] - y * t[0]];
  const rings = gaussLegendre(24);
  const depth = 1 - Math.cos(halfAngle);
  const sum = new Float64Array(order * order);
  rings.nodes.forEach((node, r) => {
    const cosine = 1 - 0.5 * depth * (1 + node);
    const sine = Math.sqrt(1 - cosine * cosine);
    for (let a = 0; a < 32; ++a) {
      const [c, s] = [sine * Math.cos((Math.PI * a) / 16), sine * Math.sin((Math.PI * a) / 16)];
      const d = [x, y, z].map((value, i) => cosine * value + c * t[i] + s * b[i]);
      const weight = (rings.weights[r] * 0.5 * depth * 2 * Math.PI) / 32;
      evaluateSh(order, ...d).forEach((value, i) => (sum[i] += weight * value));
    }
  });
  return sum;
}

test("suns are discs of uniform radiance", () => {
  const order = 10;
  const towards = [0.48, 0.6, -0.64];
  for (const halfAngle of [0.005, 0.1, 0.8, Math.PI / 2]) {
    // A receiver that faces a cap of radiance 1 gets pi sin² of it.
    const irradiance = Math.PI * Math.sin(halfAngle) ** 2;
    const expected = capIntegral(order, towards, halfAngle);
    const c = lightOfSuns([{ towards, irradiance: [irradiance, 2 * irradiance, 0], halfAngle }], order).coefficients();
    expected.forEach((value, i) => {
      near(c[3 * i], value, 1e-9, `${halfAngle}, coefficient ${i}`);
      near(c[3 * i + 1], 2 * value, 1e-9);
      near(c[3 * i + 2], 0, 1e-12);
    });
  }
});

test("suns add up, and a sun without extent is a direction", () => {
  const a = { towards: [0, 1, 0], irradiance: [1, 2, 3], halfAngle: 0 };
  const b = { towards: [0.6, 0, 0.8], irradiance: [3, 1, 0], halfAngle: 0.2 };
  const both = lightOfSuns([a, b], 6).coefficients();
  const each = [lightOfSuns([a], 6).coefficients(), lightOfSuns([b], 6).coefficients()];
  both.forEach((value, i) => near(value, each[0][i] + each[1][i], 1e-12));
  evaluateSh(6, 0, 1, 0).forEach((value, i) => near(each[0][3 * i + 2], 3 * value, 1e-12));
});

test("sky and suns together have the bands of both", () => {
  const { sky, suns } = readLightFile(file());
  const sum = sky.plus(lightOfSuns(suns, 10));
  assert.equal(sum.order, 3);
  const [s, l] = [sky.coefficients(), lightOfSuns(suns, 3).coefficients()];
  sum.coefficients().forEach((value, i) => near(value, s[i] + l[i], 1e-12));
  sky.times(0.25).coefficients().forEach((value, i) => near(value, 0.25 * s[i], 1e-12));
});
