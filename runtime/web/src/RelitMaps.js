// Lightmaps of a model as textures of radiance, which are drawn again after its light has changed.

import { ClampToEdgeWrapping, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, RepeatWrapping, WebGLRenderTarget } from "three";

function targetOf({ width, height, repeats }) {
  const wrapping = repeats ? RepeatWrapping : ClampToEdgeWrapping;
  return new WebGLRenderTarget(width, height, {
    type: HalfFloatType,
    minFilter: LinearMipmapLinearFilter,
    magFilter: LinearFilter,
    generateMipmaps: true,
    wrapS: wrapping,
    wrapT: wrapping,
    depthBuffer: false,
  });
}

export class RelitMaps {
  /** `maps`: [{ width, height, repeats, words }], with the textures of their words. `pass`: draws texels (texelPass.js). */
  constructor(maps, pass) {
    this.maps = maps;
    this.pass = pass;
    this.targets = new Map(); // by map and coordinates: a texture of three knows which coordinates look it up
    this.computed = new Map(); // by renderer, the version of the constants that its textures are of
  }

  /** Returns the radiance texture of map `i`; `texCoord`: index of its texture coordinates. */
  texture(i, texCoord) {
    const key = `${i} ${texCoord}`;
    if (!this.targets.has(key)) {
      const target = targetOf(this.maps[i]);
      target.texture.channel = texCoord;
      target.texture.name = `prtkit map ${i}`;
      this.targets.set(key, { target, map: this.maps[i] });
    }
    return this.targets.get(key).target.texture;
  }

  /** Draws all maps, unless `renderer` has drawn this version of the constants. */
  update(renderer, version) {
    if (this.computed.get(renderer) === version) return;
    if (!this.computed.has(renderer)) this.forgetLost(renderer);
    this.computed.set(renderer, version); // set first, because drawing may re-enter this function
    for (const { target, map } of this.targets.values()) this.pass.draw(renderer, target, map);
  }

  /** Forgets the maps of a lost device, so that they are drawn again when it returns. */
  forgetLost({ domElement }) {
    domElement?.addEventListener?.("webglcontextrestored", () => this.computed.clear());
  }

  /** Frees the maps on the device; a map that is still in use is created again. */
  dispose() {
    this.computed.clear();
    this.pass.dispose();
    for (const { target } of this.targets.values()) target.dispose();
    for (const { words } of this.maps) for (const texture of words) texture.dispose();
  }
}
