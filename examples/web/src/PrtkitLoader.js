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
  BufferAttribute,
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

/** Bytes of accessors of VEC4 of bytes, one after the other for each vertex, as 32-bit words [vertices][groups]. */
function packedWords(groups) {
  const count = groups[0].count;
  const words = new Uint32Array(count * groups.length);
  groups.forEach((group, g) => {
    for (let v = 0; v < count; ++v)
      words[v * groups.length + g] =
        (group.getX(v) | (group.getY(v) << 8) | (group.getZ(v) << 16) | (group.getW(v) << 24)) >>> 0;
  });
  return words;
}

/** Words [first, first + 4) of each vertex, or as many as there are. */
function wordAttribute(words, stride, first) {
  const size = Math.min(4, stride - first);
  const count = words.length / stride;
  const part = new Uint32Array(count * size);
  for (let v = 0; v < count; ++v)
    for (let w = 0; w < size; ++w) part[v * size + w] = words[v * stride + first + w];
  return new BufferAttribute(part, size);
}

/** Puts the attributes that the shader reads in place of those of the file; returns its defines. */
function convertGeometry(geometry, model) {
  const groups = [];
  for (let i = 0; geometry.hasAttribute(`_prt_weights_${i}`); ++i) {
    groups.push(geometry.getAttribute(`_prt_weights_${i}`));
    geometry.deleteAttribute(`_prt_weights_${i}`);
  }
  const { clusters } = model;
  if (clusters.widths) {
    if (groups.length === 0 || groups.length > 8)
      throw new Error(`${EXTENSION}: a primitive has ${groups.length} groups of packed weights, not 1 to 8`);
    const words = packedWords(groups);
    geometry.setAttribute("prt_words_0", wordAttribute(words, groups.length, 0));
    if (groups.length > 4) geometry.setAttribute("prt_words_1", wordAttribute(words, groups.length, 4));
    model.bytesPerVertex = 4 * groups.length;
    return { ...TABLES, PRT_PACKED_WORDS: groups.length, PRT_CLUSTER_BITS: clusters.clusterBits };
  }
  const cluster = geometry.getAttribute("_prt_cluster");
  if (!cluster || groups.length > 12)
    throw new Error(`${EXTENSION}: a primitive lacks _PRT_CLUSTER, or has more than 48 components`);
  const numbers = Uint32Array.from({ length: cluster.count }, (_, v) => cluster.getX(v));
  geometry.deleteAttribute("_prt_cluster");
  geometry.setAttribute("prt_cluster", new BufferAttribute(numbers, 1));
  groups.forEach((group, i) => geometry.setAttribute(`prt_weights_${i}`, group));
  const weight = groups.length > 0 ? (groups[0].data ?? groups[0]).array.BYTES_PER_ELEMENT : 0;
  model.bytesPerVertex = numbers.BYTES_PER_ELEMENT + 4 * groups.length * weight;
  return { ...TABLES, PRT_WEIGHT_VECTORS: groups.length };
}

/** For `GLTFLoader.register`. Files without the extension load as ever. */
export class PrtkitPlugin {
  constructor(parser) {
    this.parser = parser;
    this.name = EXTENSION;
  }

  async afterRoot(gltf) {
    const { json, associations } = this.parser;
    const extension = json.extensions?.[EXTENSION];
    if (!extension) return;
    const wanted = [extension.packing?.bufferView, extension.centers?.bufferView, extension.bases.bufferView];
    for (const part of ["origin", "units", "scales", "axes", "values"]) wanted.push(extension.bases[part]?.bufferView);
    const views = new Map();
    for (const i of wanted)
      if (i !== undefined) views.set(i, new Uint8Array(await this.parser.getDependency("bufferView", i)));
    const model = new PrtkitModel(extension, (i) => views.get(i));
    const defines = new Map(); // by geometry: nodes may share one
    for (const scene of gltf.scenes) {
      scene.updateMatrixWorld(true); // as in the file
      scene.traverse((object) => {
        const from = associations.get(object);
        if (!object.isMesh || from?.meshes === undefined) return;
        if (!defines.has(object.geometry)) {
          if (!Object.keys(object.geometry.attributes).some((name) => name.startsWith("_prt_"))) return;
          defines.set(object.geometry, convertGeometry(object.geometry, model));
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
    gltf.userData.prtkit = model;
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
