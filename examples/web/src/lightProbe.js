// Light probes of three as light for transfer.

import { MAX_ORDER, ShLight } from "./sphericalHarmonics.js";

/**
 * The light of a LightProbe, or of any with `sh.coefficients`, times its intensity: radiance in three bands, the others being
 * zero up to `order`. Three's basis is prtkit's without the Condon-Shortley phase: odd m have the other sign.
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
