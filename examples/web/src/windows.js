// Windows over the bands of a light, as in `prt render --window`: spherical harmonics of few bands ring
// around strong lights, which is visible as dark and coloured shadows.

import { ShLight } from "prtkit-web";

/** Returns the first bands of a light. */
export function truncated(light, order) {
  return new ShLight(order, light.polar.slice(0, 3 * order * order));
}

/** Returns the light with band l multiplied by factor(l / order). */
function faded(light, factor) {
  const polar = light.polar.map((value, i) => value * factor(Math.floor(Math.sqrt(Math.floor(i / 3) + 0.5)) / light.order));
  return new ShLight(light.order, polar);
}

/** Title of each window by name, and a function that applies it to a light. */
export const WINDOWS = {
  auto: { title: "automatic (no negative light)", apply: (light) => light.deringed() },
  none: { title: "none", apply: (light) => light },
  hann: { title: "Hann", apply: (light) => faded(light, (x) => 0.5 + 0.5 * Math.cos(Math.PI * x)) },
  lanczos: {
    title: "Lanczos",
    apply: (light) => faded(light, (x) => (x === 0 ? 1 : Math.sin(Math.PI * x) / (Math.PI * x))),
  },
};
