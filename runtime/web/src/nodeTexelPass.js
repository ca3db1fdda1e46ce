// Lights the texels of a map as texelPass.js does, for WebGPURenderer.

import { float, ivec2, screenCoordinate, textureLoad, uvec4, vec4 } from "three/tsl";
import { NoBlending, NodeMaterial, QuadMesh, RendererUtils } from "three/webgpu";
import { radianceOfWords } from "./radianceNodes.js";

const LARGEST_HALF = 65504; // filters and mipmaps would spread larger values

/** Returns the word of a texel in an image. */
function wordOf(image, texel) {
  const bytes = uvec4(textureLoad(image, texel).mul(255).add(0.5)).toVar();
  return bytes.x.bitOr(bytes.y.shiftLeft(8)).bitOr(bytes.z.shiftLeft(16)).bitOr(bytes.w.shiftLeft(24));
}

export class NodeTexelPass {
  constructor(model, clusterBits) {
    this.model = model;
    this.clusterBits = clusterBits;
    this.materials = new Map(); // by map
    this.quad = new QuadMesh();
  }

  material(map) {
    if (!this.materials.has(map)) {
      const material = new NodeMaterial();
      const words = () => map.words.map((image) => wordOf(image, ivec2(screenCoordinate.xy)));
      const radiance = radianceOfWords(this.model, words, this.clusterBits);
      material.fragmentNode = vec4(radiance.clamp(-LARGEST_HALF, LARGEST_HALF), float(1));
      Object.assign(material, { blending: NoBlending, depthTest: false, depthWrite: false, fog: false });
      this.materials.set(map, material);
    }
    return this.materials.get(map);
  }

  /** Draws `map` into `target`, also while `renderer` is drawing something else. */
  draw(renderer, target, map) {
    const { device, gl } = renderer.backend;
    const most = device?.limits.maxTextureDimension2D ?? gl?.getParameter(gl.MAX_TEXTURE_SIZE);
    if (Math.max(map.width, map.height) > most)
      throw new Error(`prtkit: a lightmap has ${map.width} x ${map.height} texels; this device supports at most ${most} along each side`);
    const state = RendererUtils.resetRendererState(renderer);
    renderer.setRenderTarget(target);
    this.quad.material = this.material(map);
    this.quad.render(renderer);
    RendererUtils.restoreRendererState(renderer, state);
  }

  dispose() {
    for (const material of this.materials.values()) material.dispose();
  }
}
