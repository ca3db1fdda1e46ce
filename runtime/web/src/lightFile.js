// Reads light files of `prt project` (docs/format.md). Does not use three.js.

import { evaluateSh, MAX_ORDER, ShLight } from "./sphericalHarmonics.js";

const areFinite = (values, count) =>
  Array.isArray(values) && values.length === count && values.every((value) => Number.isFinite(value));

function sunOf({ towards, irradiance, half_angle_radians: halfAngle }) {
  if (!areFinite(towards, 3) || !areFinite(irradiance, 3) || !irradiance.every((value) => value >= 0))
    throw new Error("light file: towards or irradiance of a sun is invalid");
  const length = Math.hypot(...towards);
  if (!(length > 0) || !Number.isFinite(halfAngle) || halfAngle < 0 || halfAngle > Math.PI / 2)
    throw new Error("light file: direction or half angle of a sun is invalid");
  return { towards: towards.map((value) => value / length), irradiance: [...irradiance], halfAngle };
}

/**
 * Parses the sky and the suns of a light file: { sky: ShLight, suns: [{ towards, irradiance, halfAngle }] }.
 * Throws an Error with the reason if it is invalid.
 */
export function readLightFile(json) {
  if (json?.prtkit_light !== 1) throw new Error("light file: prtkit_light is not 1");
  if (json.lights !== undefined) throw new Error("light file: the version is no longer supported; run prt project again");
  const { order, coefficients, suns = [] } = json;
  if (!Number.isInteger(order) || order < 1 || order > MAX_ORDER) throw new Error(`light file: order ${order} is not 1..10`);
  const colors = ["red", "green", "blue"].map((name) => coefficients?.[name]);
  if (!colors.every((values) => areFinite(values, order * order)))
    throw new Error(`light file: red, green and blue are not ${order * order} numbers each`);
  if (!Array.isArray(suns)) throw new Error("light file: suns is not a list");
  const values = Float64Array.from({ length: 3 * order * order }, (_, i) => colors[i % 3][Math.floor(i / 3)]);
  return { sky: ShLight.fromCoefficients(order, values), suns: suns.map(sunOf) };
}

/**
 * Returns for each band a disc's coefficients relative to those of a point with equal irradiance
 * (docs/math.md, eq. 14).
 */
function discBands(order, halfAngle) {
  const z = Math.cos(halfAngle);
  const bands = [2 / (1 + z)];
  let [before, legendre] = [1, z]; // P_(l-1), P_l
  let [derivativeBefore, derivative] = [0, 1];
  for (let l = 1; l < order; ++l) {
    bands.push((2 * derivative) / (l * (l + 1)));
    [derivativeBefore, derivative] = [derivative, derivativeBefore + (2 * l + 1) * legendre];
    [before, legendre] = [legendre, ((2 * l + 1) * z * legendre - l * before) / (l + 1)];
  }
  return bands;
}

/** Returns the sum of suns as spherical harmonics, for light after a bounce. */
export function lightOfSuns(suns, order = MAX_ORDER) {
  const coefficients = new Float64Array(3 * order * order);
  for (const { towards, irradiance, halfAngle } of suns) {
    const bands = discBands(order, halfAngle);
    evaluateSh(order, ...towards).forEach((value, i) => {
      const factor = bands[Math.floor(Math.sqrt(i + 0.5))] * value;
      for (let channel = 0; channel < 3; ++channel) coefficients[3 * i + channel] += factor * irradiance[channel];
    });
  }
  return ShLight.fromCoefficients(order, coefficients);
}
