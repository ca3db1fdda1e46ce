// Automatic exposure from the light of the model, without the sky behind it, as in `prt render`.

import { FloatType, NearestFilter, WebGLRenderTarget } from "three";

const SIZE = 48; // pixels along each side
const MEAN_SHOWN = 0.22;

/** Draws into a small target and reads it back. Needs a device that can draw floats. */
export class ExposureMeter {
  constructor(renderer) {
    this.renderer = renderer;
    this.possible = renderer.extensions.has("EXT_color_buffer_float") && renderer.extensions.has("EXT_float_blend");
    if (!this.possible) return;
    this.target = new WebGLRenderTarget(SIZE, SIZE, { type: FloatType, minFilter: NearestFilter, magFilter: NearestFilter });
    this.pixels = new Float32Array(4 * SIZE * SIZE);
  }

  /**
   * Returns a good exposure of `scene`, which must contain only the model; null if no lit surface is visible.
   */
  exposure(scene, camera) {
    if (!this.possible) return null;
    const { renderer, target, pixels } = this;
    renderer.setRenderTarget(target);
    renderer.clear();
    renderer.render(scene, camera);
    renderer.readRenderTargetPixels(target, 0, 0, SIZE, SIZE, pixels);
    renderer.setRenderTarget(null);
    let luminance = 0;
    let covered = 0;
    for (let i = 0; i < pixels.length; i += 4) {
      luminance += 0.2126 * pixels[i] + 0.7152 * pixels[i + 1] + 0.0722 * pixels[i + 2];
      covered += pixels[i + 3];
    }
    return luminance > 0 ? (MEAN_SHOWN * covered) / luminance : null;
  }
}
