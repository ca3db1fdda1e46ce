// Compressed precomputed radiance transfer for three.js: a plug-in of its GLTFLoader.
//
//   const loader = new GLTFLoader().register((parser) => new PrtkitPlugin(parser));
//   const gltf = await loader.loadAsync("shipped.glb");
//   const sky = await new HDRLoader().setDataType(FloatType).loadAsync("sky.hdr");
//   const { prtkit } = gltf.userData;
//   const light = projectEquirectangular(sky, prtkit.order).deringed(); // as three shows it: its centre looks at +X
//   scene.background = scene.environment = halfFloatSky(sky);
//   prtkit.setLight(light, angle); // again when the light turns or changes
//
// With suns apart, of a light file of `prt project --suns auto`:
//
//   const { sky, suns } = readLightFile(await (await fetch("light.json")).json());
//   const lights = new SunLights(suns).fit(gltf.scene).turn(angle);
//   scene.add(lights);
//   prtkit.setLight(sky.deringed(), angle, lightOfSuns(suns, prtkit.order));
//
// Where the model has a light set (`prt bake --light-set`), suns have hard shadows without any light of three's:
//
//   prtkit.setLight(sky.deringed(), angle, null, prtkit.strengthsOfSuns(suns, angle));
//
// Models made with --meshopt want loader.setMeshoptDecoder(MeshoptDecoder), as three's loader does for all such files.

import {
  DataTexture,
  DataUtils,
  EquirectangularReflectionMapping,
  FloatType,
  HalfFloatType,
  LinearFilter,
  NearestFilter,
  RGBAFormat,
  RGBAIntegerFormat,
  UnsignedIntType,
  Vector3,
} from "three";
import { bakedFrame } from "./bakedFrame.js";
import { clusterTable, decodeClusters, formConstants, lightColumns, shaderRows } from "./clusteredPca.js";
import { strengthsOfSuns } from "./lightSet.js";
import { relitMaterial, sunTraits } from "./relitMaterial.js";
import { MAX_ORDER, projectLatLong } from "./sphericalHarmonics.js";
import { convertGeometry } from "./vertexWeights.js";
import { checkExtension, viewsOf } from "./wholeExtension.js";

export { lightOfSuns, readLightFile } from "./lightFile.js";
export { ShLight } from "./sphericalHarmonics.js";
export { SunLights } from "./SunLights.js";

const EXTENSION = "PRTKIT_clustered_pca";
const TEXTURE_WIDTH = 256;
/** Of the shader: where its tables are. */
const TABLES = { PRT_CONSTANTS_TEXTURE: 1, PRT_TEXTURE_WIDTH: TEXTURE_WIDTH };

function tableTexture(count, data, format, type, internalFormat) {
  const height = Math.max(1, Math.ceil(count / TEXTURE_WIDTH));
  const padded = new data.constructor(4 * TEXTURE_WIDTH * height);
  padded.set(data);
  const texture = new DataTexture(padded, TEXTURE_WIDTH, height, format, type);
  texture.internalFormat = internalFormat;
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** The compressed transfer of one file, shared by its meshes. */
export class PrtkitModel {
  constructor(extension, view) {
    this.clusters = decodeClusters(extension, view);
    this.rows = shaderRows(this.clusters);
    const { rowCount, components } = this.clusters;
    this.constantsTexture = tableTexture(rowCount, new Float32Array(4 * rowCount), RGBAFormat, FloatType, "RGBA32F");
    this.clustersTexture = tableTexture(
      components.length,
      clusterTable(this.clusters),
      RGBAIntegerFormat,
      UnsignedIntType,
      "RGBA32UI",
    );
    this.order = this.clusters.order;
    this.channels = Math.max(...this.clusters.parts.map((part) => part.channels));
    this.directApart = this.clusters.parts[0].kind === "direct";
    /** Names of the lamps that can be dimmed. */
    const lamps = this.clusters.parts.filter(({ kind }) => kind === "lamp");
    this.lamps = lamps.filter(({ towards }) => !towards).map(({ name }) => name);
    /** Keys of the light set by which suns can shine: { name, towards }. */
    this.keys = lamps.filter(({ towards }) => towards);
    /** By lamp or key, what its strength is; of shining materials, uniforms. */
    this.strengths = new Map(lamps.map(({ name }) => [name, { value: new Vector3() }]));
    this.setStrengths({});
    this.uniforms = {
      prt_constants: { value: this.constantsTexture },
      prt_clusters: { value: this.clustersTexture },
      prtSunsApart: { value: false },
    };
    this.vertices = 0;
    this.bytesPerVertex = 0;
  }

  /**
   * Lights all meshes by `light` turned about +Y by `angle` radians: forms the constants of all clusters. `suns`: those
   * that three's directional lights add with their shadows; here they light what is lit after a bounce. Where direct light
   * is not apart they light in full here, and three's lights add nothing. `lamps`: strengths by name, numbers or
   * [red, green, blue]; those that it does not name shine as in the scene.
   */
  setLight(light, angle = 0, suns = null, lamps = {}) {
    for (const { order } of suns ? [light, suns] : [light])
      if (order < this.order) throw new RangeError(`the light has order ${order}, the model needs ${this.order}`);
    this.setStrengths(lamps);
    const strengths = [...this.strengths.values()].flatMap(({ value }) => value.toArray());
    const sunlight = suns ? suns.coefficients(angle) : null;
    const columns = lightColumns(this.clusters, light.coefficients(angle), sunlight, strengths);
    formConstants(this.clusters, this.rows, columns, this.constantsTexture.image.data);
    this.constantsTexture.needsUpdate = true;
    this.uniforms.prtSunsApart.value = suns !== null && this.directApart;
  }

  /**
   * Strengths of the keys by which `suns` shine, turned as `setLight` turns its light: what `lamps` of it is given beside
   * those of lamps, in the place of suns that three's lights add.
   */
  strengthsOfSuns(suns, angle = 0) {
    if (this.keys.length === 0) throw new RangeError("the model has no light set");
    return strengthsOfSuns(this.keys, suns, angle);
  }

  /** By which what a material of this name shines with is multiplied. */
  strengthOf(material) {
    const lamp = this.clusters.parts.find(
      ({ kind, name, towards, members = [name] }) => kind === "lamp" && !towards && members.includes(material),
    );
    return lamp ? this.strengths.get(lamp.name) : { value: new Vector3(1, 1, 1) };
  }

  setStrengths(lamps) {
    const given = Object.entries(lamps).map(([name, strength]) => [
      name,
      typeof strength === "number" ? [strength, strength, strength] : strength,
    ]);
    for (const [name, strength] of given) {
      if (!this.strengths.has(name)) throw new RangeError(`there is no lamp "${name}"`);
      if (strength?.length !== 3 || ![...strength].every((value) => value >= 0 && value < Infinity))
        throw new RangeError(`the strength of lamp "${name}" is neither a number nor three, or below zero`);
    }
    for (const { value } of this.strengths.values()) value.set(0, 0, 0);
    for (const name of this.lamps) this.strengths.get(name).value.set(1, 1, 1);
    for (const [name, strength] of given) this.strengths.get(name).value.set(...strength);
  }

  dispose() {
    this.constantsTexture.dispose();
    this.clustersTexture.dispose();
  }
}

/** For `GLTFLoader.register`. Files without the extension load as ever. */
export class PrtkitPlugin {
  constructor(parser) {
    this.parser = parser;
    this.name = EXTENSION;
  }

  async afterRoot(gltf) {
    const extension = this.parser.json.extensions?.[EXTENSION];
    if (!extension) return;
    checkExtension(extension);
    const views = new Map();
    for (const i of viewsOf(extension)) views.set(i, new Uint8Array(await this.viewOf(i)));
    const model = new PrtkitModel(extension, (i) => views.get(i));
    this.convert(gltf, model);
    gltf.userData.prtkit = model;
  }

  /** The bytes of a buffer view; three knows best whether they are there. */
  async viewOf(i) {
    try {
      return await this.parser.getDependency("bufferView", i);
    } catch (error) {
      throw new Error(`${EXTENSION}: buffer view ${i} cannot be read`, { cause: error });
    }
  }

  /** Gives the meshes of `gltf` what lights them. */
  convert(gltf, model) {
    const { json, associations } = this.parser;
    const defines = new Map(); // by geometry: nodes may share one
    for (const scene of gltf.scenes) {
      scene.updateMatrixWorld(true); // as in the file
      scene.traverse((object) => {
        const from = associations.get(object);
        if (!object.isMesh || from?.meshes === undefined) return;
        if (!defines.has(object.geometry)) {
          if (!Object.keys(object.geometry.attributes).some((name) => name.startsWith("_prt_"))) return;
          const converted = convertGeometry(object.geometry, model.clusters);
          defines.set(object.geometry, { ...TABLES, ...converted.defines });
          model.bytesPerVertex = converted.bytesPerVertex;
          model.vertices += object.geometry.getAttribute("position").count;
        }
        const primitive = json.meshes?.[from.meshes]?.primitives?.[from.primitives];
        const number = primitive?.material;
        const gltfMaterial = json.materials?.[number];
        const traits = model.directApart ? sunTraits(gltfMaterial) : null;
        const frame = bakedFrame(object, model.clusters.guides);
        const strength = model.strengthOf(gltfMaterial?.name || `material ${number}`);
        object.material = relitMaterial(object.material, {
          uniforms: { ...model.uniforms, ...frame.uniforms, prtStrength: strength },
          defines: { ...defines.get(object.geometry), ...frame.defines },
          traits,
        });
        if (!traits) return;
        object.castShadow = traits.casts;
        object.receiveShadow = true;
      });
    }
  }
}

/** How the texels of an equirectangular texture are stored. */
function texels(texture) {
  const { width, height, data } = texture.image;
  const stride = texture.format === RGBAFormat ? 4 : data.length / (width * height);
  if (stride < 3) throw new Error("the environment has fewer than three channels");
  const value = texture.type === HalfFloatType ? DataUtils.fromHalfFloat : (v) => v;
  // HDRLoader stores the top row first and asks for a flip, EXRLoader has it flipped already.
  return { width, height, data, stride, topFirst: texture.flipY, value };
}

/**
 * The lighting of an equirectangular texture of HDRLoader or EXRLoader, from the directions where three shows it as
 * `scene.background`: +Y on top, the centre column looks at +X. `center: "z"` is for images of OpenEXR's layout, which
 * three shows turned by 90 degrees. Load the texture with setDataType(FloatType): half floats cut off a sun.
 */
export function projectEquirectangular(texture, order = MAX_ORDER, { center = "x" } = {}) {
  return projectLatLong({ ...texels(texture), center }, order);
}

const LARGEST_HALF = 65504;

/**
 * A copy of an equirectangular texture for `scene.background` and `scene.environment`, in half floats, where a sun above
 * 65504 is cut off: three keeps environments in half floats, and one infinite texel turns all its materials black.
 */
export function halfFloatSky(texture) {
  const { width, height, data, stride, value } = texels(texture);
  const halves = new Uint16Array(4 * width * height);
  for (let i = 0; i < width * height; ++i) {
    for (let c = 0; c < 3; ++c)
      halves[4 * i + c] = DataUtils.toHalfFloat(Math.min(Math.max(value(data[i * stride + c]), 0), LARGEST_HALF));
    halves[4 * i + 3] = DataUtils.toHalfFloat(1);
  }
  const sky = new DataTexture(halves, width, height, RGBAFormat, HalfFloatType, EquirectangularReflectionMapping);
  sky.minFilter = sky.magFilter = LinearFilter;
  sky.colorSpace = texture.colorSpace;
  sky.flipY = texture.flipY;
  sky.needsUpdate = true;
  return sky;
}
