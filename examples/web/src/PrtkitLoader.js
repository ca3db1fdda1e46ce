// Compressed precomputed radiance transfer for three.js: a plug-in of its GLTFLoader.
//
//   const loader = new GLTFLoader().register((parser) => new PrtkitPlugin(parser));
//   const gltf = await loader.loadAsync("shipped.glb");
//   const sky = await new HDRLoader().setDataType(FloatType).loadAsync("sky.hdr");
//   const { prtkit } = gltf.userData;
//   const light = projectEquirectangular(sky, prtkit.order).deringed(); // as three shows it: its centre looks at +X
//   scene.background = scene.environment = halfFloatSky(sky);
//   prtkit.setSky(light, scene); // follows scene.environmentRotation; setLight(light, angle) turns it by hand
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

import { bakedFrame } from "./bakedFrame.js";
import { PrtkitModel, TABLES } from "./PrtkitModel.js";
import { relitMaterial, sunTraits } from "./relitMaterial.js";
import { convertGeometry } from "./vertexWeights.js";
import { checkExtension, viewsOf } from "./wholeExtension.js";

export { halfFloatSky, projectEquirectangular } from "./equirectangular.js";
export { lightOfSuns, readLightFile } from "./lightFile.js";
export { lightFromProbe } from "./lightProbe.js";
export { PrtkitModel } from "./PrtkitModel.js";
export { projectInWorker } from "./projectInWorker.js";
export { ShLight } from "./sphericalHarmonics.js";
export { SunLights } from "./SunLights.js";

const EXTENSION = "PRTKIT_clustered_pca";

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
    const model = new PrtkitModel(extension, (i) => views.get(i), gltf.scene);
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
          beforeRender: model.beforeRender,
        });
        if (!traits) return;
        object.castShadow = traits.casts;
        object.receiveShadow = true;
      });
    }
  }
}
