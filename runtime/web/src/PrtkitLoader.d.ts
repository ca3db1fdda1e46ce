import type { Box3, Data3DTexture, DataTexture, DirectionalLight, Group, InstancedMesh, IUniform, LightProbe, Object3D, Scene, Vector3 } from "three";
import type { GLTF, GLTFLoaderPlugin, GLTFParser } from "three/examples/jsm/loaders/GLTFLoader.js";

/** Returns the order² values of the SH basis in the unit direction (x, y, z); writes them to `out`. */
export function evaluateSh(order: number, x: number, y: number, z: number, out?: Float64Array): Float64Array;

/** Lighting as spherical harmonics, for rotation about +Y. */
export class ShLight {
  readonly order: number;
  /** Coefficients about the polar axis +Y, [order²][3]. */
  readonly polar: Float64Array;
  constructor(order: number, polar: Float64Array);
  /** Creates a light from RGB coefficients [order²][3] in prtkit's convention. */
  static fromCoefficients(order: number, coefficients: ArrayLike<number>): ShLight;
  /** Returns RGB coefficients [order²][3] in prtkit's convention, rotated about +Y by `angle` radians. */
  coefficients(angle?: number): Float64Array;
  /**
   * Returns this light rotated or mirrored by `matrix`, nine numbers by columns (as in three's Matrix3):
   * light from direction d then comes from `matrix` times d.
   */
  rotated(matrix: ArrayLike<number>): ShLight;
  /** Returns the sum of this light and `other`, in the bands that both have. */
  plus(other: ShLight): ShLight;
  /** Returns this light multiplied by a factor. */
  times(factor: number): ShLight;
  /**
   * Returns the light under the weakest filter that makes it nowhere negative if for lights of few bands, once
   * for each.
   */
  deringed(): ShLight;
  /** Returns the luminance of the mean radiance over all directions; 0.25 divided by it is a good exposure. */
  meanLuminance(): number;
}

/** Factor on each lamp by name: a number, or red, green and blue. */
export type LampStrengths = Record<string, number | ArrayLike<number>>;

/** Options of `setSky` in addition to the light. */
export interface SkyOptions {
  /**
   * DirectionalLights of the scene, read in every frame: three renders their direct light with shadows, and
   * their light after a bounce is added here. Or the light that SunLights, which `follow` the scene, add; see
   * setLight.
   */
  suns?: ShLight | DirectionalLight[] | null;
  lamps?: LampStrengths;
}

/** Common interface of surfaces and volumes that are lit by transfer. */
export class LitTransfer {
  readonly order: number;
  readonly channels: 1 | 3;
  /** True if the transfer has a separate direct term, so that suns can have sharp shadows. */
  readonly hasDirectTerm: boolean;
  /** Names of the lamps that can be dimmed: lights and emissive materials of the scene, and groups of them. */
  readonly lamps: string[];
  /**
   * Lights the whole file by `light`, with or without its suns. `suns`: light that the scene's directional
   * lights add with their shadows; it is used here only after a bounce. Without `suns`, and if `hasDirectTerm`
   * is false, three's lights add nothing. Lamps that `lamps` does not name keep the strength of the scene.
   * Throws a RangeError for a light of fewer bands than `order`, for unknown lamps, and for strengths below
   * zero. In the next frame, console.warn names each light of the scene that has no effect, once.
   */
  setLight(light: ShLight, angle?: number, suns?: ShLight | null, lamps?: LampStrengths): void;
  /**
   * Lights the whole file by `light` as `scene` shows it, in every frame: rotated by its environmentRotation
   * and times its environmentIntensity, or by those of the background if it has no environment; and relative
   * to the rotation of `gltf.scene`. Applies until `setLight` or `setSky` is called again. Throws as setLight
   * does.
   */
  setSky(light: ShLight, scene: Scene, options?: SkyOptions): void;
}

/**
 * The compressed transfer of the surfaces of one file: `gltf.userData.prtkit`. Its light is also set on
 * `volume`.
 */
export class PrtkitModel extends LitTransfer {
  /** Number of vertices with transfer. */
  readonly vertices: number;
  /**
   * Bytes of the vertex attributes of transfer, as bound: packed weights in whole 32-bit words, floats as
   * vectors of four plus a separate word for the cluster.
   */
  readonly bytesPerVertex: number;
  /**
   * Number of texels of lightmaps with transfer, and bytes per texel. A model with transfer of texels and of vertices
   * shows that of texels; `vertices` is then 0.
   */
  readonly texels: number;
  readonly bytesPerTexel: number;
  /** Light of moving objects, if the file has a volume. */
  readonly volume: PrtkitVolume | null;
  /** Instances that share the transfer of their mesh, if the file has any. */
  readonly instances: PrtkitInstances | null;
  /** Figures that rotate with their skins, if the file also has lobes; they get the same light and are freed together. */
  readonly figure: PrtkitLobes | null;
  /** Sets the occluders that darken surfaces near them; null: none. Throws an Error with WebGPURenderer. */
  setOccluders(occluders: PrtkitOccluders | null): void;
  /**
   * Frees the tables and lightmaps on the device; materials and geometries are disposed of as usual in three.
   */
  dispose(): void;
}

/** Instances that share the transfer of their mesh (PRTKIT_instances): `gltf.userData.prtkit.instances`. */
export class PrtkitInstances {
  /** Number of instances drawn, and their `meshes`: one for each primitive of the shared meshes. */
  readonly count: number;
  readonly meshes: InstancedMesh[];
  /** Bytes of an instance in the file, and mean bytes of its constants on the device. */
  readonly bytesPerInstance: number;
  readonly constantsBytesPerInstance: number;
}

/**
 * Transfer of a figure that rotates with its skin (PRTKIT_lobes): `gltf.userData.prtkit` of files from `prt
 * lobes`, and `gltf.userData.prtkit.figure` if the file also has transfer of surfaces. Separate suns light it through three's directional lights and their shadow maps.
 */
export class PrtkitLobes extends LitTransfer {
  /** Number of lobes per vertex, four bytes each. */
  readonly lobes: 1 | 2 | 3;
  readonly vertices: number;
  readonly bytesPerVertex: number;
  /** Light of moving objects, if the file also has a volume. */
  readonly volume: PrtkitVolume | null;
  /** Frees the table of profiles on the device. */
  dispose(): void;
}

/**
 * Objects of a file that occlude surfaces near them (PRTKIT_occlusion_volume): `gltf.userData.prtkitOccluders`.
 */
export class PrtkitOccluders {
  /** Number of visible occluders. */
  readonly count: number;
  /** Updates the positions of the occluders; `PrtkitModel` calls it before it is drawn. */
  update(): void;
  dispose(): void;
}

/** Probes of a file, with or without surfaces: `gltf.userData.prtkit.volume`. */
export class PrtkitVolume extends LitTransfer {
  /** Number of bands of incident light at probes. */
  readonly incidentOrder: 2 | 3 | 4;
  readonly probes: number;
  /** Bytes of words and visibility distances; the bases do not depend on the number of probes. */
  readonly bytesPerProbe: number;
  /** The volume itself, for symmetry with a model. */
  readonly volume: PrtkitVolume;
  /**
   * Lights `object` and its descendants at their position from now on: its meshes get copies of their
   * materials, and cast and receive shadows of suns. Meshes with transfer, and materials that three does not
   * light, are unchanged. Throws an Error for materials other than MeshStandardMaterial, MeshPhysicalMaterial
   * and MeshLambertMaterial. Returns `object`.
   */
  light<T extends Object3D>(object: T): T;
  /** True if the light set last is complete: a change of light is computed in steps, one before each frame. */
  readonly isSettled: boolean;
  /** Completes the computation now. */
  settle(): this;
  /** Position of a probe in world space of the file, and whether it is inside geometry. */
  positionOfProbe(probe: number): Vector3;
  isSealed(probe: number): boolean;
  /** Inputs of custom shaders: the uniforms that `volumeShader` reads, and its defines. */
  readonly uniforms: Record<string, IUniform>;
  readonly defines: Record<string, number>;
  /** Updates light and position before a custom shader is drawn. */
  readonly beforeRender: (renderer: unknown) => void;
  /** Light of the probes. */
  readonly texture: Data3DTexture;
  /** Frees the textures on the device. */
  dispose(): void;
}

/**
 * GLSL for lookups in a volume, for custom fragment shaders (GLSL ES 3.0): prt_volume_irradiance and the other
 * functions of shaders/prt_volume.glsl, for a position and a normal transformed by prtToVolume.
 */
export const volumeShader: string;

/**
 * Reads PRTKIT_transfer, PRTKIT_instances, PRTKIT_lobes and PRTKIT_occlusion_volume, for WebGLRenderer; that of
 * `prtkit-web/webgpu` for WebGPURenderer: `loader.register((parser) => new PrtkitPlugin(parser))`. Loading fails for a
 * file that is not compressed, and for a file of a former version.
 */
export class PrtkitPlugin implements GLTFLoaderPlugin {
  readonly name: string;
  constructor(parser: GLTFParser);
  afterRoot(gltf: GLTF): Promise<void>;
}

/** A distant disc of uniform radiance. */
export interface Sun {
  /** Unit direction to its center. */
  towards: number[];
  /** Irradiance on a receiver that faces it: red, green, blue. */
  irradiance: number[];
  /** Angular radius in radians; 0: a point. */
  halfAngle: number;
}

/**
 * Reads the JSON of `prt project --suns`: the sky without its suns, and the suns. Throws an Error for invalid
 * input.
 */
export function readLightFile(json: unknown): { sky: ShLight; suns: Sun[] };

/** Returns the sum of the suns as spherical harmonics: the third argument of `setLight`. */
export function lightOfSuns(suns: Sun[], order?: number): ShLight;

/**
 * Suns as three's directional lights, with shadow maps fitted to the lit objects. Add it directly to the
 * scene.
 */
export class SunLights extends Group {
  readonly lights: DirectionalLight[];
  /** `mapSize`: texels along each side of a shadow map, 2048 if unset. */
  constructor(suns: Sun[], options?: { mapSize?: number });
  /**
   * Fits the shadow maps to `object`: objects outside neither cast nor receive shadows. Throws a RangeError
   * if it is empty.
   */
  fit(object: Object3D | Box3): this;
  /** Rotates the suns about +Y by `angle` radians, as `setLight` does with the light. */
  rotate(angle: number): this;
  /**
   * Rotates and dims the suns in every frame as `scene` does its environment, as `setSky` does with the
   * light.
   */
  follow(scene: Scene): this;
  /** Multiplies the original strength of the suns by a factor. */
  dim(factor: number): this;
  dispose(): void;
}

/** Axis that the centre column of an equirectangular image faces. */
export interface EquirectangularLayout {
  /** "x": as three shows it (the default). "z": the layout of OpenEXR and of `prt`. */
  center?: "x" | "z";
}

/**
 * Projects an equirectangular texture of HDRLoader or EXRLoader, loaded with `setDataType(FloatType)`, in the
 * orientation in which three shows it as `scene.background`. Throws an Error for a texture of fewer than
 * three channels and a RangeError for an order outside 1..10.
 */
export function projectEquirectangular(texture: DataTexture, order?: number, layout?: EquirectangularLayout): ShLight;

/**
 * Projects a texture like projectEquirectangular, in a worker: rejects with its errors, and with an Error if
 * the worker does not start. Without workers, as in node, it runs in the calling thread.
 */
export function projectInWorker(texture: DataTexture, order?: number, layout?: EquirectangularLayout): Promise<ShLight>;

/**
 * Returns the light of a LightProbe of three, times its intensity: three bands, the others up to `order` are
 * zero.
 */
export function lightFromProbe(probe: Pick<LightProbe, "sh"> & { intensity?: number }, order?: number): ShLight;

/**
 * Returns a copy in half floats for `scene.background` and `scene.environment`, limited to 65504, because a
 * brighter texel would make materials lit by the environment black. `center: "z"`: the image is rotated, so that three
 * shows it in the directions from which it lights.
 */
export function halfFloatSky(texture: DataTexture, layout?: EquirectangularLayout): DataTexture;
