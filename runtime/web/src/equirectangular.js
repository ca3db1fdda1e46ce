// Projects equirectangular textures of HDRLoader and EXRLoader, and converts them for display by three.

import {
  DataTexture,
  DataUtils,
  EquirectangularReflectionMapping,
  HalfFloatType,
  LinearFilter,
  RGBAFormat,
} from "three";
import { MAX_ORDER, projectLatLong } from "./sphericalHarmonics.js";

/** Returns the storage layout of the texels of an equirectangular texture. */
export function texels(texture) {
  const { width, height, data } = texture.image;
  const stride = texture.format === RGBAFormat ? 4 : data.length / (width * height);
  if (stride < 3) throw new Error("the environment has fewer than three channels");
  const value = texture.type === HalfFloatType ? DataUtils.fromHalfFloat : (v) => v;
  // HDRLoader stores the top row first and requires a flip, EXRLoader has flipped it already.
  return { width, height, data, stride, topFirst: texture.flipY, value };
}

/**
 * Returns the lighting of an equirectangular texture, in the orientation in which three shows it as
 * `scene.background`: +Y at the top, the centre column faces +X. `center: "z"` is for images with OpenEXR's
 * layout, which `halfFloatSky` rotates for three. Load the texture with setDataType(FloatType), because half
 * floats clip a sun.
 */
export function projectEquirectangular(texture, order = MAX_ORDER, { center = "x" } = {}) {
  return projectLatLong({ ...texels(texture), center }, order);
}

const LARGEST_HALF = 65504;

/**
 * Returns a copy of an equirectangular texture for `scene.background` and `scene.environment`, in half
 * floats, limited to 65504: three stores environments in half floats, and one infinite texel makes all its
 * materials black. With `center: "z"` its columns are moved by a quarter of the width, so that three shows
 * the center at +Z.
 */
export function halfFloatSky(texture, { center = "x" } = {}) {
  const { width, height, data, stride, value } = texels(texture);
  const moved = center === "z" ? width / 4 : 0;
  const [whole, part] = [Math.floor(moved), moved % 1];
  const halves = new Uint16Array(4 * width * height);
  const finite = (v) => Math.min(Math.max(v, 0), LARGEST_HALF);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const at = 4 * (y * width + x);
      const right = (y * width + ((x - whole + width) % width)) * stride;
      const left = (y * width + ((x - whole - 1 + width) % width)) * stride;
      for (let c = 0; c < 3; ++c) {
        // If the width is not a multiple of four, interpolates between two columns.
        const here = finite(value(data[right + c]));
        halves[at + c] = DataUtils.toHalfFloat(part === 0 ? here : (1 - part) * here + part * finite(value(data[left + c])));
      }
      halves[at + 3] = DataUtils.toHalfFloat(1);
    }
  const sky = new DataTexture(halves, width, height, RGBAFormat, HalfFloatType, EquirectangularReflectionMapping);
  sky.minFilter = sky.magFilter = LinearFilter;
  sky.colorSpace = texture.colorSpace;
  sky.flipY = texture.flipY;
  sky.needsUpdate = true;
  return sky;
}
