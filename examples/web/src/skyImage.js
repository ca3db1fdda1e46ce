// Computes an image of light given only as spherical harmonics, to be shown behind the model.

import { DataTexture, FloatType, RGBAFormat } from "three";
import { evaluateSh } from "prtkit-web";

const HEIGHT = 64;

/** Returns a lat-long image, +Z in the middle, in the layout of HDRLoader; negative radiance becomes black. */
export function skyImage(light) {
  const { order } = light;
  const coefficients = light.coefficients();
  const width = 2 * HEIGHT;
  const data = new Float32Array(4 * width * HEIGHT);
  const basis = new Float64Array(order * order);
  for (let y = 0; y < HEIGHT; ++y)
    for (let x = 0; x < width; ++x) {
      const theta = (Math.PI * (y + 0.5)) / HEIGHT;
      const azimuth = 2 * Math.PI * (0.5 - (x + 0.5) / width); // from +Z towards +X
      const sine = Math.sin(theta);
      evaluateSh(order, sine * Math.sin(azimuth), Math.cos(theta), sine * Math.cos(azimuth), basis);
      const at = 4 * ((HEIGHT - 1 - y) * width + x);
      for (let c = 0; c < 3; ++c)
        data[at + c] = Math.max(0, basis.reduce((sum, value, i) => sum + value * coefficients[3 * i + c], 0));
      data[at + 3] = 1;
    }
  const texture = new DataTexture(data, width, HEIGHT, RGBAFormat, FloatType);
  texture.needsUpdate = true;
  return texture;
}
