// Transfer of figures that rotates with their skins: zonal lobes of vertices (docs/format.md, PRTKIT_lobes),
// and their light.

import { DataTexture, FloatType, NearestFilter, Object3D, RGBAFormat, Vector3 } from "three";
import { LitSurfaces } from "./LitSurfaces.js";
import { expect, LOBES } from "./wholeExtension.js";

const LARGEST_GAIN = 1e3;
const holds = (value, what) => expect(value, what, LOBES);

/**
 * Returns the gains of all profiles, [count][4]: those of the existing bands, then 0. `bytes`: their buffer
 * view.
 */
export function profilesOf({ order, profiles: { count } }, bytes) {
  holds(bytes.byteLength === 4 * order * count, `the profiles are not ${count} times ${order} floats`);
  const gains = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
  holds(gains.every((gain) => Math.abs(gain) <= LARGEST_GAIN), `gains of profiles are not finite or exceed ${LARGEST_GAIN}`);
  return Float32Array.from({ length: 4 * count }, (_, i) => (i % 4 < order ? gains[order * (i >> 2) + (i % 4)] : 0));
}

/** Replaces the file's lobe attributes by those of the shader. */
function convertLobes(geometry, { lobes, profiles: { count } }) {
  for (let k = 0; k < lobes; ++k) {
    const attribute = geometry.getAttribute(`_prt_lobe_${k}`);
    const { array } = attribute?.data ?? attribute ?? {};
    const isRight = array instanceof Uint8Array && attribute.itemSize === 4 && attribute.count === geometry.getAttribute("position")?.count;
    holds(isRight && !attribute.normalized, `a primitive has no _PRT_LOBE_${k} of four bytes for each vertex`);
    for (let v = 0; v < attribute.count; ++v) holds(attribute.getZ(v) < count, `vertex ${v} names a profile that does not exist`);
    geometry.deleteAttribute(`_prt_lobe_${k}`);
    geometry.setAttribute(`prt_lobe_${k}`, attribute);
  }
}

export class PrtkitLobes extends LitSurfaces {
  /** `extension`: validated; `bytes`: its profiles. */
  constructor(extension, bytes) {
    const { order, lobes } = extension;
    // The renderer's shadow maps handle separate suns. Axes are rotated to world space, and so is the light
    // of skies.
    super({ order, terms: [{ kind: "direct", channels: 3 }] }, new Object3D());
    this.extension = extension;
    /** Lobes of a vertex. */
    this.lobes = lobes;
    this.vertices = 0;
    this.bytesPerVertex = 4 * lobes;
    this.instances = null;
    const profiles = profilesOf(extension, bytes);
    this.profilesTexture = new DataTexture(profiles, profiles.length / 4, 1, RGBAFormat, FloatType);
    Object.assign(this.profilesTexture, { minFilter: NearestFilter, magFilter: NearestFilter, needsUpdate: true });
    this.uniforms = {
      prt_lobe_profiles: { value: this.profilesTexture },
      prtLobeLight: { value: Array.from({ length: order * order }, () => new Vector3()) },
      prtSeparateSuns: { value: false },
    };
    this.defines = { PRT_LOBES: lobes, PRT_LOBE_ORDER: order };
    this.converted = new Set(); // geometries: nodes may share one
    this.beforeRender = (renderer, scene) => {
      this.followSky();
      this.checkLights(scene);
    };
  }

  /** Returns the transfer of `mesh`, null without lobes. */
  transferOf({ geometry }) {
    if (!geometry.hasAttribute("_prt_lobe_0") && !this.converted.has(geometry)) return null;
    if (!this.converted.has(geometry)) {
      convertLobes(geometry, this.extension);
      this.vertices += geometry.getAttribute("position").count;
      this.converted.add(geometry);
    }
    return { uniforms: {}, defines: this.defines };
  }

  update(sky, suns) {
    this.uniforms.prtLobeLight.value.forEach((light, i) => light.fromArray(sky, 3 * i));
    this.uniforms.prtSeparateSuns.value = suns !== null;
  }

  /** Frees the table on the device. */
  dispose() {
    this.sky = null;
    this.volume?.dispose();
    this.profilesTexture.dispose();
  }
}
