import type { Box3, Data3DTexture, DataTexture, DirectionalLight, Group, InstancedMesh, IUniform, LightProbe, Object3D, Scene, Vector3 } from "three";
import type { GLTF, GLTFLoaderPlugin, GLTFParser } from "three/examples/jsm/loaders/GLTFLoader.js";

/** Lighting as spherical harmonics that turns about +Y. */
export class ShLight {
  readonly order: number;
  /** Coefficients about the polar axis +Y, [order²][3]. */
  readonly polar: Float64Array;
  constructor(order: number, polar: Float64Array);
  /** Of RGB coefficients [order²][3] in prtkit's convention. */
  static fromCoefficients(order: number, coefficients: ArrayLike<number>): ShLight;
  /** RGB coefficients [order²][3] in prtkit's convention, turned about +Y by `angle` radians. */
  coefficients(angle?: number): Float64Array;
  /** This light turned or mirrored by `matrix`, nine numbers by columns (as of three's Matrix3): what comes from d comes
   * from `matrix` times d. */
  rotated(matrix: ArrayLike<number>): ShLight;
  /** This light and `other` together, in the bands that both have. */
  plus(other: ShLight): ShLight;
  /** This light so many times as strong. */
  times(factor: number): ShLight;
  /** The same light under the least filter that leaves it nowhere negative: for lights of few bands, once for each. */
  deringed(): ShLight;
  /** Luminance of the mean radiance over all directions; 0.25 over it is a good exposure. */
  meanLuminance(): number;
}

/** By name what a lamp is dimmed or coloured by: a number, or red, green and blue. */
export type LampStrengths = Record<string, number | ArrayLike<number>>;

/** What `setSky` takes beside the light. */
export interface SkyOptions {
  /** DirectionalLights of the scene, read in every frame: they light directly with their own shadows, here what is lit after a
   * bounce. Or, as of setLight, what the scene's directional lights (SunLights, which `follow` the scene) add. */
  suns?: ShLight | DirectionalLight[] | null;
  lamps?: LampStrengths;
}

/** What surfaces and volumes have alike: what lights them. */
export class LitTransfer {
  readonly order: number;
  readonly channels: 1 | 3;
  /** Whether direct light is kept apart, so that suns can be lit with sharp shadows. */
  readonly directApart: boolean;
  /** Names of the lamps that can be dimmed: lights and shining materials of the scene, and groups of them. */
  readonly lamps: string[];
  /** Lights all of the file by `light`, all of it or without its suns. `suns`: those that the scene's directional
   * lights add with their shadows; they light here what is lit after a bounce. Without them, and where `directApart` is
   * false, three's lights add nothing. Lamps that `lamps` does not name shine as in the scene.
   * Throws a RangeError for a light of fewer bands than `order`, for lamps that are not there, and for strengths below zero.
   * When it is drawn next, console.warn names each light of the scene that does not light it, once. */
  setLight(light: ShLight, angle?: number, suns?: ShLight | null, lamps?: LampStrengths): void;
  /** Lights all of the file by `light` as `scene` shows it, from frame to frame: turned by its environmentRotation and
   * times its environmentIntensity, or by those of the background where it has no environment; and as `gltf.scene` is turned
   * itself. Until `setLight` or `setSky` is called again. Throws as setLight does. */
  setSky(light: ShLight, scene: Scene, options?: SkyOptions): void;
}

/** The compressed transfer of the surfaces of one file: `gltf.userData.prtkit`. Its light is that of `volume`, too. */
export class PrtkitModel extends LitTransfer {
  /** Vertices that have transfer. */
  readonly vertices: number;
  /** Of the vertex attributes that transfer takes, as they are bound: packed weights in whole 32-bit words, floats
   * as vectors of four beside the cluster in a word of its own. */
  readonly bytesPerVertex: number;
  /** Texels of lightmaps that have transfer, where vertices have none, and the bytes of words of each. */
  readonly texels: number;
  readonly bytesPerTexel: number;
  /** Light of what moves, where the file has a volume. */
  readonly volume: PrtkitVolume | null;
  /** What is drawn of instances that share the transfer of their mesh, where the file has some. */
  readonly instances: PrtkitInstances | null;
  /** What takes light from the surfaces as it passes near them; null: nothing. Throws an Error with WebGPURenderer. */
  setOccluders(occluders: PrtkitOccluders | null): void;
  /** Frees the tables and lightmaps on the device; materials and geometries are disposed of as all of three's. */
  dispose(): void;
}

/** Instances that share the transfer of their mesh (PRTKIT_instances): `gltf.userData.prtkit.instances`. */
export class PrtkitInstances {
  /** How many are drawn, by `meshes`: one for each primitive of the meshes that they share. */
  readonly count: number;
  readonly meshes: InstancedMesh[];
  /** What the file has of each, and on average their constants on the device. */
  readonly bytesPerInstance: number;
  readonly constantsBytesPerInstance: number;
}

/** Transfer of a figure that turns with its skin (PRTKIT_lobes): `gltf.userData.prtkit` of files of `prt lobes`. Suns that are apart
 * light it by three's directional lights and their shadow maps. */
export class PrtkitLobes extends LitTransfer {
  /** Of each vertex, four bytes each. */
  readonly lobes: 1 | 2 | 3;
  readonly vertices: number;
  readonly bytesPerVertex: number;
  /** Light of what moves, where the file has a volume, too. */
  readonly volume: PrtkitVolume | null;
  /** Frees the table of profiles on the device. */
  dispose(): void;
}

/** Parts of a file that take light from what they pass (PRTKIT_occlusion_volume): `gltf.userData.prtkitOccluders`. */
export class PrtkitOccluders {
  /** How many are shown. */
  readonly count: number;
  /** Takes the parts where they are; `PrtkitModel` does so before it is drawn. */
  update(): void;
  dispose(): void;
}

/** The probes of a file, beside its surfaces or alone: `gltf.userData.prtkit.volume`. */
export class PrtkitVolume extends LitTransfer {
  /** Bands of the light that comes in at probes. */
  readonly incidentOrder: 2 | 3 | 4;
  readonly probes: number;
  /** Of words and sights; the bases are as large for one as for all. */
  readonly bytesPerProbe: number;
  /** Itself, as a model has it. */
  readonly volume: PrtkitVolume;
  /** Lights `object` and what it holds where it is, from now on: its meshes get copies of their materials, and cast and receive
   * shadows of suns. What transfer lights, and what has no light of three's, stays what it is. Throws an Error for materials other
   * than MeshStandardMaterial, MeshPhysicalMaterial and MeshLambertMaterial. Returns `object`. */
  light<T extends Object3D>(object: T): T;
  /** A change of light is formed in steps, one before each picture; whether that is done. */
  readonly isSettled: boolean;
  /** Does it now. */
  settle(): this;
  /** Of a probe in the world of the file, and whether it is inside of something. */
  placeOfProbe(probe: number): Vector3;
  isSealed(probe: number): boolean;
  /** For shaders of your own: what `volumeShader` reads, and the defines that it wants. */
  readonly uniforms: Record<string, IUniform>;
  readonly defines: Record<string, number>;
  /** Brings light and place up to date, before such a shader is drawn. */
  readonly beforeRender: (renderer: unknown) => void;
  /** The light of the probes. */
  readonly texture: Data3DTexture;
  /** Frees the textures on the device. */
  dispose(): void;
}

/** GLSL that looks a volume up, for fragment shaders of your own (GLSL ES 3.0): prt_volume_irradiance and the others of
 * shaders/prt_volume.glsl, of a place and a normal that prtToVolume has taken there. */
export const volumeShader: string;

/** Reads PRTKIT_clustered_pca, PRTKIT_instances, PRTKIT_lightmap, PRTKIT_lobes and PRTKIT_transfer_volume, for WebGLRenderer; that of `prtkit-web/webgpu` for WebGPURenderer:
 * `loader.register((parser) => new PrtkitPlugin(parser))`. */
export class PrtkitPlugin implements GLTFLoaderPlugin {
  readonly name: string;
  constructor(parser: GLTFParser);
  afterRoot(gltf: GLTF): Promise<void>;
}

/** A disc of uniform radiance far away. */
export interface Sun {
  /** Unit direction to its middle. */
  towards: number[];
  /** On a receiver that faces it: red, green, blue. */
  irradiance: number[];
  /** Radians; 0: it has no extent. */
  halfAngle: number;
}

/** What `prt project --suns` wrote, parsed from JSON: the sky without its suns, and these. Throws an Error for what is none. */
export function readLightFile(json: unknown): { sky: ShLight; suns: Sun[] };

/** Suns together as spherical harmonics: the third argument of `setLight`. */
export function lightOfSuns(suns: Sun[], order?: number): ShLight;

/** Suns as three's directional lights, with shadow maps that are fitted to what they shine on. Add it to the scene itself. */
export class SunLights extends Group {
  readonly lights: DirectionalLight[];
  /** `mapSize`: texels along each side of a shadow map, 2048 if unset. */
  constructor(suns: Sun[], options?: { mapSize?: number });
  /** What is outside of `object` neither casts shadows nor gets any. Throws a RangeError where it is empty. */
  fit(object: Object3D | Box3): this;
  /** Turns the suns about +Y by `angle` radians, as `setLight` does the light. */
  turn(angle: number): this;
  /** Turns and dims the suns in every frame as `scene` does its environment: as `setSky` does the light. */
  follow(scene: Scene): this;
  /** Makes the suns so many times as strong as they were at first. */
  dim(factor: number): this;
  dispose(): void;
}

/** Which axis the centre column of an equirectangular image looks at. */
export interface EquirectangularLayout {
  /** "x": as three shows it (the default). "z": the layout of OpenEXR and of `prt`. */
  center?: "x" | "z";
}

/**
 * The lighting of an equirectangular texture of HDRLoader or EXRLoader, loaded with `setDataType(FloatType)`, from where
 * three shows it as `scene.background`. Throws an Error for a texture of fewer than three channels and a RangeError for
 * an order outside 1..10.
 */
export function projectEquirectangular(texture: DataTexture, order?: number, layout?: EquirectangularLayout): ShLight;

/**
 * The same, by a worker: rejects with what projectEquirectangular throws, and with an Error where the worker does not start.
 * Where there are no workers, as in node, the caller does it.
 */
export function projectInWorker(texture: DataTexture, order?: number, layout?: EquirectangularLayout): Promise<ShLight>;

/** The light of a LightProbe of three, times its intensity: three bands, the others zero up to `order`. */
export function lightFromProbe(probe: Pick<LightProbe, "sh"> & { intensity?: number }, order?: number): ShLight;

/**
 * A copy in half floats for `scene.background` and `scene.environment`, cut off at 65504: a brighter texel would turn
 * materials that are lit by the environment black. `center: "z"`: turned, so that three shows it where it lights.
 */
export function halfFloatSky(texture: DataTexture, layout?: EquirectangularLayout): DataTexture;
