// Converts light probes of three to light for transfer.

import { MAX_ORDER, ShLight } from "./sphericalHarmonics.js";

/**
 * Returns the light of a LightProbe, or of any object with `sh.coefficients`, times its intensity: three bands; the others are
 * zero up to `order`. Three's basis is prtkit's without the Condon-Shortley phase: odd m have the opposite sign.
 */
export function lightFromProbe({ sh, intensity = 1 }, order = MAX_ORDER) {
  const coefficients = new Float64Array(3 * order * order);
  sh.coefficients.slice(0, order * order).forEach((color, i) => {
    const l = Math.floor(Math.sqrt(i));
    const m = i - l * (l + 1);
    const sign = m % 2 === 0 ? intensity : -intensity;
    coefficients.set(color.toArray().map((value) => sign * value), 3 * i);
  });
  return ShLight.fromCoefficients(order, coefficients);
}
