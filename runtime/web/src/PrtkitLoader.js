// Compressed precomputed radiance transfer for three.js: a plug-in of its GLTFLoader.
//
//   const loader = new GLTFLoader().register((parser) => new PrtkitPlugin(parser));
//   const gltf = await loader.loadAsync("shipped.glb");
//   const sky = await new HDRLoader().setDataType(FloatType).loadAsync("sky.hdr");
//   const { prtkit } = gltf.userData;
//   const light = projectEquirectangular(sky, prtkit.order).deringed(); // as three shows it: its centre faces +X
//   scene.background = scene.environment = halfFloatSky(sky);
//   prtkit.setSky(light, scene); // follows scene.environmentRotation; setLight(light, angle) rotates it explicitly
//
// With separate suns, from a light file of `prt project --suns auto`:
//
//   const { sky, suns } = readLightFile(await (await fetch("light.json")).json());
//   const lights = new SunLights(suns).fit(gltf.scene).rotate(angle);
//   scene.add(lights);
//   prtkit.setLight(sky.deringed(), angle, lightOfSuns(suns, prtkit.order));
//
// Moving objects in a model with a volume (`prt bake --volume`) are lit at their position:
//
//   prtkit.volume.light(character.scene);
//
// Models made with --meshopt need loader.setMeshoptDecoder(MeshoptDecoder), as all such files do.

import { decodeVertices, removeWeights } from "./codedVertices.js";
import { setFallbackAside } from "./fallback.js";
import { putInstancesBack, takeInstancesAside } from "./instanceNodes.js";
import { PrtkitInstances } from "./PrtkitInstances.js";
import { PrtkitLobes } from "./PrtkitLobes.js";
import { occludersOf, PrtkitOccluders } from "./PrtkitOccluders.js";
import { PrtkitVolume } from "./PrtkitVolume.js";
import { copiedMaterial, relitMaterial, sunTraits } from "./relitMaterial.js";
import { TexelPass } from "./texelPass.js";
import { transferOfTexels } from "./texelTransfer.js";
import { noteLightsOfFile } from "./unusedLights.js";
import { transferOfVertices } from "./vertexTransfer.js";
import { volumeOf } from "./volumeTransfer.js";
import { checkLobes, expect, INSTANCES, LOBES, OCCLUDERS, PROBES, setsOf, TEXELS, TRANSFER, VERTICES, viewsOf } from "./wholeExtension.js";

export { halfFloatSky, projectEquirectangular } from "./equirectangular.js";
export { lightOfSuns, readLightFile } from "./lightFile.js";
export { lightFromProbe } from "./lightProbe.js";
export { LitTransfer } from "./LitTransfer.js";
export { PrtkitInstances } from "./PrtkitInstances.js";
export { PrtkitLobes } from "./PrtkitLobes.js";
export { PrtkitModel } from "./PrtkitModel.js";
export { PrtkitOccluders } from "./PrtkitOccluders.js";
export { PrtkitVolume } from "./PrtkitVolume.js";
export { projectInWorker } from "./projectInWorker.js";
export { evaluateSh, ShLight } from "./sphericalHarmonics.js";
export { SunLights } from "./SunLights.js";
export { VOLUME as volumeShader } from "./transferShader.js";

/** For `GLTFLoader.register`. Files without transfer load as usual. */
export class PrtkitPlugin {
  constructor(parser) {
    this.parser = parser;
    this.name = TRANSFER;
    this.canOcclude = true;
    this.canShare = true; // instances and lobes
    this.instances = []; // nodes whose meshes share transfer
    this.checkedSets = null;
  }

  /** The sets of transfer of the file; see setsOf. */
  get sets() {
    return (this.checkedSets ??= setsOf(this.parser.json));
  }

  async beforeRoot() {
    const { json } = this.parser;
    const { vertices, texels } = this.sets;
    const lobes = json.extensions?.[LOBES];
    expect(!texels || !json.extensions[INSTANCES], "the file also has transfer of texels", INSTANCES);
    if (vertices?.fallback) setFallbackAside(json);
    if (vertices && texels) removeWeights(json);
    else if (vertices) {
      await decodeVertices(this.parser, vertices, (list) => this.viewsOf(list, VERTICES));
      this.instances = takeInstancesAside(json);
    }
    const isDrawn = (have, name) => expect(!have || this.canShare, "WebGPURenderer is not supported; use WebGLRenderer and prtkit-web", name);
    isDrawn(this.instances.length > 0, INSTANCES);
    isDrawn(lobes, LOBES);
  }

  async afterRoot(gltf) {
    const { vertices, texels, probes } = this.sets;
    const lobes = this.parser.json.extensions?.[LOBES];
    const name = vertices || texels || probes ? TRANSFER : lobes && LOBES;
    expect(!name || gltf.scene, "the file has no scene", name);
    const occluders = await occludersOf(this.parser, gltf, (list) => this.viewsOf(list, OCCLUDERS));
    if (occluders.length > 0) gltf.userData.prtkitOccluders = new PrtkitOccluders(occluders);
    const volume = probes ? await this.volume(probes, gltf.scene) : null;
    const figure = lobes ? await this.lobesModel(lobes, gltf) : null; // first: its meshes then have no other transfer
    if (vertices || texels) gltf.userData.prtkit = Object.assign(await this.surfaces(vertices, texels, gltf), { volume, figure });
    else if (figure) gltf.userData.prtkit = Object.assign(figure, { volume });
    else if (volume) gltf.userData.prtkit = volume;
    if (gltf.userData.prtkit) gltf.scenes.forEach(noteLightsOfFile);
  }

  /** Returns the model of surfaces: of texels, if the file has texels and vertices. */
  async surfaces(vertices, texels, gltf) {
    const { model, of, definesOf } = texels
      ? await transferOfTexels(texels, (list) => this.viewsOf(list, TEXELS), gltf.scene, this.parser, this.passOf)
      : await transferOfVertices(vertices, (list) => this.viewsOf(list, VERTICES), gltf.scene);
    model.canOcclude = this.canOcclude;
    if (this.instances.length > 0) model.instances = await this.sharing(gltf, model, definesOf);
    this.convert(gltf, model, of);
    return model;
  }

  /** Creates the instances of the file. */
  async sharing(gltf, model, definesOf) {
    const { parser } = this;
    const extension = parser.json.extensions[INSTANCES];
    const views = [extension.factors, extension.lamps].filter(Boolean).map(({ bufferView }) => bufferView);
    const loaded = await this.viewsOf(views, INSTANCES);
    const [bytes, lampBytes] = views.map((view) => loaded.get(view));
    gltf.scene.updateMatrixWorld(true);
    putInstancesBack(parser.json, this.instances);
    return PrtkitInstances.of(this.instances, { gltf, parser, model, extension, bytes, lampBytes, definesOf });
  }

  /** Returns the model of lobes that rotate with a skin. */
  async lobesModel(extension, gltf) {
    checkLobes(extension);
    const { bufferView } = extension.profiles;
    const model = new PrtkitLobes(extension, (await this.viewsOf([bufferView], LOBES)).get(bufferView));
    this.convert(gltf, model, (mesh) => model.transferOf(mesh));
    return model;
  }

  async volume(set, root) {
    const bytes = await this.viewsOf(viewsOf(set), PROBES);
    return new PrtkitVolume(volumeOf(set, (i) => bytes.get(i)), root, this);
  }

  /** Returns the bytes of buffer views; three reports missing ones. */
  async viewsOf(list, name) {
    const views = new Map();
    for (const i of list)
      try {
        views.set(i, new Uint8Array(await this.parser.getDependency("bufferView", i)));
      } catch (error) {
        throw new Error(`${name}: buffer view ${i} cannot be read`, { cause: error });
      }
    return views;
  }

  /** Creates the pass that draws the lightmaps of `model`, for WebGLRenderer. */
  passOf(model, defines, words) {
    return new TexelPass(model.uniforms, defines, words);
  }

  materialOf(source, transfer) {
    return relitMaterial(source, transfer);
  }

  /** Returns a material for moving objects in a volume. */
  copiedMaterial(source, transfer) {
    return copiedMaterial(source, transfer);
  }

  /** Checks the renderer before a mesh is drawn: a different renderer would ignore its light. */
  checkRenderer(renderer) {
    if (!renderer.isWebGLRenderer) throw new Error("prtkit: WebGPURenderer needs PrtkitPlugin of prtkit-web/webgpu");
  }

  /** Assigns transfer to the meshes of `gltf`. `of(mesh, primitive)` returns their transfer. */
  convert(gltf, model, of) {
    const { json, associations } = this.parser;
    const media = this.sets.vertices?.bake?.media ?? []; // materials with media that their extensions do not describe
    for (const scene of gltf.scenes) {
      scene.updateMatrixWorld(true); // matrices of the file
      scene.traverse((object) => {
        const from = associations.get(object);
        if (!object.isMesh || from?.meshes === undefined) return;
        const primitive = json.meshes?.[from.meshes]?.primitives?.[from.primitives];
        const transfer = of(object, primitive);
        if (!transfer) return;
        const number = primitive?.material;
        const gltfMaterial = json.materials?.[number];
        const name = gltfMaterial?.name || `material ${number}`;
        const traits = model.hasDirectTerm ? sunTraits(gltfMaterial, media.includes(name)) : null;
        const strength = model.strengthOf(name);
        object.material = this.materialOf(object.material, {
          ...transfer,
          uniforms: { ...model.uniforms, ...transfer.uniforms, prtStrength: strength },
          traits,
          model,
        });
        object.onBeforeRender = this.checkRenderer;
        if (!traits) return;
        object.castShadow = traits.casts;
        object.receiveShadow = true;
      });
    }
  }
}
