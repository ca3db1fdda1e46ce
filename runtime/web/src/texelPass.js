// Lights the texels of a map by shaders/prt_lightmap.frag, for WebGLRenderer.

import { GLSL3, NoBlending, RawShaderMaterial } from "three";
import { FullScreenQuad } from "three/examples/jsm/postprocessing/Pass.js";
import fragmentShader from "./prt_lightmap.frag.js";

const PRECISION = "precision highp float;\nprecision highp int;\n";
const VERTEX = "in vec3 position;\nvoid main() { gl_Position = vec4(position.xy, 0.0, 1.0); }";

export class TexelPass {
  /** `uniforms`, `defines`: of the model's tables; `words`: words per texel. */
  constructor(uniforms, defines, words) {
    const material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: PRECISION + VERTEX,
      fragmentShader: PRECISION + fragmentShader,
      uniforms: { ...uniforms, prt_word_images: { value: [] } },
      defines: { ...defines, PRT_PACKED_WORDS: words, PRT_NORMALIZED_WORDS: 1 },
      blending: NoBlending,
      depthTest: false,
      depthWrite: false,
    });
    this.quad = new FullScreenQuad(material);
  }

  /** Draws `map` into `target`, also while `renderer` is drawing something else. */
  draw(renderer, target, { width, height, words }) {
    const { maxTextureSize } = renderer.capabilities;
    if (Math.max(width, height) > maxTextureSize)
      throw new Error(`prtkit: a lightmap has ${width} x ${height} texels; this device supports at most ${maxTextureSize} along each side`);
    this.quad.material.uniforms.prt_word_images.value = words;
    const before = [renderer.getRenderTarget(), renderer.getActiveCubeFace(), renderer.getActiveMipmapLevel()];
    const isImmersive = renderer.xr.enabled;
    renderer.xr.enabled = false; // XR would replace the camera
    renderer.setRenderTarget(target);
    this.quad.render(renderer);
    renderer.setRenderTarget(...before);
    renderer.xr.enabled = isImmersive;
  }

  dispose() {
    this.quad.material.dispose(); // its geometry is shared by all passes
  }
}
