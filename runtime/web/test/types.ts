// Compiled, never run: checks that the declarations match three's.
import { DirectionalLight, FloatType, Group, LightProbe, Mesh, Scene, ShaderMaterial } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { HDRLoader } from "three/examples/jsm/loaders/HDRLoader.js";
import {
  halfFloatSky,
  lightFromProbe,
  lightOfSuns,
  PrtkitModel,
  PrtkitPlugin,
  PrtkitVolume,
  projectEquirectangular,
  projectInWorker,
  readLightFile,
  ShLight,
  SunLights,
  volumeShader,
} from "../src/PrtkitLoader.js";
import { PrtkitPlugin as NodePlugin, PrtkitModel as Model } from "../src/webgpu.js";

export async function show(scene: Scene): Promise<number> {
  const loader = new GLTFLoader().register((parser) => new PrtkitPlugin(parser));
  const gltf = await loader.loadAsync("model.glb");
  const sky = await new HDRLoader().setDataType(FloatType).loadAsync("sky.hdr");
  const light: ShLight = projectEquirectangular(sky, 6);
  projectEquirectangular(sky, 6, { center: "z" });
  // @ts-expect-error only two layouts exist
  projectEquirectangular(sky, 6, { center: "y" });
  scene.background = scene.environment = halfFloatSky(sky, { center: "z" });
  const model: PrtkitModel = gltf.userData.prtkit;
  model.setLight(light, Math.PI / 2);
  // @ts-expect-error a light is not an angle
  model.setLight(1);
  scene.add(gltf.scene);
  const lighting = readLightFile(await (await fetch("light.json")).json());
  const suns = new SunLights(lighting.suns, { mapSize: 1024 }).fit(gltf.scene).rotate(1);
  scene.add(suns);
  model.setLight(lighting.sky.deringed(), 1, lightOfSuns(lighting.suns, model.order));
  model.setLight(lighting.sky, 1, null, { [model.lamps[0]]: 0.5, Sign: [1, 0.5, 0] });
  model.setSky(await projectInWorker(sky, 6, { center: "z" }), scene, { suns: lightOfSuns(lighting.suns) });
  model.setSky(lightFromProbe(new LightProbe()).rotated([1, 0, 0, 0, 1, 0, 0, 0, 1]), scene);
  model.setSky(light, scene, { suns: [new DirectionalLight()] });
  // @ts-expect-error other lights cannot be suns
  model.setSky(light, scene, { suns: [new LightProbe()] });
  suns.follow(scene).lights[0].shadow.autoUpdate = false;
  const volume: PrtkitVolume | null = model.volume;
  if (volume) {
    const character: Group = volume.light(new Group());
    // @ts-expect-error a number does not move
    volume.light(3);
    volume.settle().setLight(light, 1);
    const own = new ShaderMaterial({ uniforms: volume.uniforms, defines: volume.defines, fragmentShader: volumeShader });
    scene.add(character, new Mesh(undefined, own));
    if (!volume.isSettled && volume.isSealed(0)) scene.position.copy(volume.positionOfProbe(0));
  }
  const nodes: Model = (await new GLTFLoader().register((parser) => new NodePlugin(parser)).loadAsync("model.glb")).userData.prtkit;
  return model.bytesPerVertex * model.vertices + nodes.bytesPerTexel * nodes.texels;
}
