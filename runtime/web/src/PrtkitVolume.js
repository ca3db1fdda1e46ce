// Light of moving objects in a scene: the probes of a file, computed into textures, for three's materials.

import {
  Data3DTexture,
  FloatType,
  HalfFloatType,
  LinearFilter,
  Matrix4,
  NearestFilter,
  Object3D,
  RedIntegerFormat,
  RGBAFormat,
  RGIntegerFormat,
  UnsignedIntType,
  Vector3,
} from "three";
import { LitTransfer } from "./LitTransfer.js";
import { movingMaterial } from "./relitMaterial.js";
import { VolumeRelighter } from "./VolumeRelighter.js";
import { positionOf, SIDE } from "./volumeGrid.js";
import { atlasOf, indexTexels, visibilityTexels } from "./volumeTextures.js";

/** Number of products with the light and of probes that are computed in one frame: about 4 ms each. */
const PRODUCTS_AT_ONCE = 3e6;
const PROBES_AT_ONCE = 6144;

function texture3d(data, size, format, type) {
  const texture = new Data3DTexture(data, ...size);
  Object.assign(texture, { format, type, minFilter: NearestFilter, magFilter: NearestFilter, needsUpdate: true });
  return texture;
}

/**
 * Returns the unit direction from which most light of the suns comes: for one sun its direction; null without
 * light.
 */
function directionOf(coefficients) {
  const [y, z, x] = [1, 2, 3].map((i) => [0.2126, 0.7152, 0.0722].reduce((sum, share, c) => sum + share * coefficients[3 * i + c], 0));
  const length = Math.hypot(x, y, z);
  return length > 0 ? [-x / length, -y / length, z / length] : null;
}

/** Computes the requested light of the volume in steps of a few milliseconds. */
function* updating(relighter, clusters, { columns, sun }, texels) {
  const count = clusters.components.length;
  const rows = clusters.rowCount / count;
  const atOnce = Math.max(1, Math.floor(PRODUCTS_AT_ONCE / (rows * (relighter.rows.length / clusters.rowCount))));
  for (let k = 0; k < count; k += atOnce) yield relighter.updateConstants(columns, sun, k, Math.min(k + atOnce, count));
  for (let p = 0; p < relighter.probes; p += PROBES_AT_ONCE)
    yield relighter.update(p, Math.min(p + PROBES_AT_ONCE, relighter.probes), texels);
}

export class PrtkitVolume extends LitTransfer {
  /**
   * `volume`: see volumeOf; `root`: the scene of the file. `plugin`: has the materials of its renderer.
   * `floats`: store light as unfiltered floats, not as half floats.
   */
  constructor(volume, root, plugin, { floats = false } = {}) {
    super(volume.clusters, root);
    this.source = volume;
    this.plugin = plugin;
    const { grid, order, visibility } = volume;
    this.incidentOrder = order;
    this.probes = grid.levels.length;
    this.bytesPerProbe = 4 * volume.stride + 6;
    this.atlas = atlasOf(grid, order);
    this.relighter = new VolumeRelighter(volume, this.atlas);
    const Texels = floats ? Float32Array : Uint16Array;
    this.spare = new Texels(4 * this.atlas.texels * this.atlas.planes);
    const [x, y, z] = this.atlas.bricks.map((bricks) => SIDE * bricks);
    this.texture = texture3d(this.spare.slice(), [x, y, z * this.atlas.planes], RGBAFormat, floats ? FloatType : HalfFloatType);
    if (!floats) this.texture.minFilter = this.texture.magFilter = LinearFilter;
    const visibilityTexture = texture3d(visibilityTexels(grid, visibility, this.atlas), [x, y, z], RGIntegerFormat, UnsignedIntType);
    const indexTexture = texture3d(indexTexels(grid), grid.size, RedIntegerFormat, UnsignedIntType);
    this.defines = { PRT_VOLUME: 1, PRT_VOLUME_ORDER: order, ...(floats ? {} : { PRT_VOLUME_LINEAR: 1 }) };
    this.uniforms = {
      prt_volume_light: { value: this.texture },
      prt_volume_visibility: { value: visibilityTexture },
      prt_volume_index: { value: indexTexture },
      prtVolumeSpacing: { value: grid.spacing },
      prtVolumeSize: { value: grid.size },
      prtVolumeFirst: { value: [...grid.bricks.subarray(0, 4)] },
      prtVolumeBricks: { value: this.atlas.bricks },
      prtToVolume: { value: new Matrix4() },
      prtSkyLight: { value: Array.from({ length: order * order }, () => new Vector3()) },
      prtSeparateSuns: { value: false },
    };
    this.asked = null; // requested light that is not computed yet
    this.steps = null; // steps of the light being computed
    this.hasLight = false; // any light
    this.frame = -1;
    this.renderers = new WeakSet(); // renderers whose textures are large enough
    this.tables = null; // tables of nodes
    this.beforeRender = (renderer, scene) => {
      this.checkLights(scene);
      this.advance(renderer);
    };
    this.updateTransform();
  }

  /** Returns this volume, for symmetry with a model. */
  get volume() {
    return this;
  }

  /**
   * Lights `object` and its descendants at their position from now on: its meshes get copies of their
   * materials, and cast and receive shadows of suns. Meshes with transfer, and materials that three does not
   * light, are unchanged. Throws an Error for other materials.
   */
  light(object) {
    object.traverse((mesh) => {
      if (!mesh.isMesh) return;
      const lit = (material) => movingMaterial(material, this, this.plugin.copiedMaterial);
      const { material } = mesh;
      mesh.material = Array.isArray(material) ? material.map(lit) : lit(material);
      const materials = [mesh.material].flat().filter(({ _transfer }) => _transfer?.model === this);
      if (materials.length === 0) return;
      mesh.receiveShadow = true;
      mesh.castShadow = materials.some(({ transparent, transmission = 0 }) => !transparent && transmission === 0);
      if (mesh.onBeforeRender === Object3D.prototype.onBeforeRender) mesh.onBeforeRender = this.plugin.checkRenderer;
    });
    return object;
  }

  /** Returns the position of a probe in the world of the file. */
  positionOfProbe(probe) {
    return new Vector3(...positionOf(this.source.grid, probe));
  }

  /** True if a probe is inside geometry and has no light. */
  isSealed(probe) {
    return this.source.visibility.subarray(6 * probe, 6 * probe + 6).every((visibility) => visibility === 0);
  }

  /**
   * Requests light, as coefficients in the space of the bake: it is computed when an object is drawn with it.
   */
  update(sky, suns) {
    const separate = suns !== null && this.hasDirectTerm;
    const open = sky.map((value, i) => value + (suns && !separate ? suns[i] : 0));
    this.asked = { columns: this.columns(sky, suns), sun: separate ? directionOf(suns) : null, separate, open };
  }

  /** True if the last light that was set is drawn: a change takes a few frames. */
  get isSettled() {
    return !this.asked && !this.steps;
  }

  /** Computes the light that was set immediately. */
  settle() {
    this.followSky();
    while (!this.isSettled) this.step();
    return this;
  }

  step() {
    if (!this.steps) {
      this.updating = this.asked;
      this.asked = null;
      this.steps = updating(this.relighter, this.clusters, this.updating, this.spare);
    }
    if (this.steps.next().done) this.show(this.updating);
  }

  /** Replaces the shown light by the computed one. */
  show({ separate, open }) {
    this.steps = null;
    this.hasLight = true;
    [this.spare, this.texture.image.data] = [this.texture.image.data, this.spare];
    this.texture.needsUpdate = true;
    this.uniforms.prtSeparateSuns.value = separate;
    this.uniforms.prtSkyLight.value.forEach((light, i) => light.fromArray(open, 3 * i));
  }

  /** Updates the transform of the file's scene. */
  updateTransform() {
    const origin = new Matrix4().makeTranslation(...this.source.grid.origin.map((value) => -value));
    this.uniforms.prtToVolume.value.copy(this.root.matrixWorld).invert().premultiply(origin);
  }

  /** Throws if the device does not support textures of the volume's size; 256 texels per side are guaranteed. */
  checkSize(renderer) {
    if (this.renderers.has(renderer)) return;
    const { device, gl = renderer.getContext?.() } = renderer.backend ?? {};
    const most = device?.limits.maxTextureDimension3D ?? gl?.getParameter(gl.MAX_3D_TEXTURE_SIZE);
    const { width, height, depth } = this.texture.image;
    const longest = Math.max(width, height, depth, ...this.source.grid.size);
    if (longest > most) throw new Error(`prtkit: the volume needs a texture with a side of ${longest} texels; this device supports at most ${most}`);
    this.renderers.add(renderer);
  }

  /** Called before an object is drawn: computes one step per frame, and all steps before the first frame. */
  advance(renderer) {
    const { frame, calls } = renderer.info.render; // WebGPURenderer counts only calls
    if ((frame ?? calls) === this.frame) return;
    this.frame = frame ?? calls;
    this.checkSize(renderer);
    this.updateTransform();
    this.followSky();
    if (!this.hasLight) this.settle();
    else if (!this.isSettled) this.step();
  }

  /** Frees the textures on the device. */
  dispose() {
    this.sky = null;
    for (const name of ["prt_volume_light", "prt_volume_visibility", "prt_volume_index"]) this.uniforms[name].value.dispose();
    for (const { texture } of this.tables ?? []) texture.dispose();
  }
}
