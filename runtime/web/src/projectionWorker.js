// Worker: receives { image, order }, returns { order, polar } of its light, or { error }.

import { halfFloat } from "./halfFloat.js";
import { projectLatLong } from "./sphericalHarmonics.js";

globalThis.onmessage = ({ data: { image, order } }) => {
  try {
    const light = projectLatLong({ ...image, value: image.half ? halfFloat : undefined }, order);
    globalThis.postMessage({ order: light.order, polar: light.polar }, [light.polar.buffer]);
  } catch (error) {
    globalThis.postMessage({ error: error.message });
  }
};
