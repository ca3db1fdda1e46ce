// Windows over the bands of a light, as `prt render --window` has them: spherical harmonics of few bands ring about strong
// lights, which shows as dark and coloured shadows.

import { ShLight } from "./sphericalHarmonics.js";

/** The first bands of a light. */
export function truncated(light, order) {
  return new ShLight(order, light.polar.slice(0, 3 * order * order));
}

/** The light with band l times factor(l / order). */
function faded(light, factor) {
  const polar = light.polar.map((value, i) => value * factor(Math.floor(Math.sqrt(Math.floor(i / 3) + 0.5)) / light.order));
  return new ShLight(light.order, polar);
}

/** By name: what it is called, and the light under it. */
export const WINDOWS = {
  auto: { title: "auto: no negative light", apply: (light) => light.deringed() },
  none: { title: "none", apply: (light) => light },
  hann: { title: "Hann", apply: (light) => faded(light, (x) => 0.5 + 0.5 * Math.cos(Math.PI * x)) },
  lanczos: {
    title: "Lanczos",
    apply: (light) => faded(light, (x) => (x === 0 ? 1 : Math.sin(Math.PI * x) / (Math.PI * x))),
  },
};
