// An application of the installed package: installed.mjs builds it with Vite and requests pictures.
import {
  AmbientLight,
  BasicShadowMap,
  DataTexture,
  EquirectangularReflectionMapping,
  FloatType,
  Fog,
  InstancedMesh,
  LinearToneMapping,
  Matrix4,
  MeshStandardMaterial,
  PerspectiveCamera,
  PointLight,
  RGBAFormat,
  Scene,
  WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { EXRLoader } from "three/examples/jsm/loaders/EXRLoader.js";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { MeshoptDecoder } from "three/examples/jsm/libs/meshopt_decoder.module.js";
import { halfFloatSky, lightOfSuns, PrtkitPlugin, projectInWorker, SunLights } from "prtkit-web";

const [width, height] = [320, 180];
const renderer = new WebGLRenderer({ antialias: true });
renderer.setSize(width, height, false);
renderer.toneMapping = LinearToneMapping;
renderer.shadowMap.enabled = true;
renderer.shadowMap.type = BasicShadowMap;
const target = new WebGLRenderTarget(width, height, { type: FloatType });

const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).register((parser) => new PrtkitPlugin(parser));
const load = (url) => loader.loadAsync(url);

/** Returns the radiance of all pixels, RGBA. */
function radiance(scene, camera) {
  const pixels = new Float32Array(4 * width * height);
  renderer.setRenderTarget(target);
  renderer.clear();
  renderer.render(scene, camera);
  renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
  renderer.setRenderTarget(null);
  return pixels;
}

function cameraAt(position, towards, fieldOfView = 40) {
  const camera = new PerspectiveCamera(fieldOfView, width / height, 0.05, 100);
  camera.position.set(...position);
  camera.lookAt(...towards);
  return camera;
}

/** Returns the root mean squared difference relative to that of `b`, and the ratio of the means, over pixels where both are nonzero. */
function compared(a, b) {
  let [difference, squares, sumA, sumB] = [0, 0, 0, 0];
  for (let i = 0; i < a.length; ++i) {
    if (i % 4 === 3 || !(a[i] > 0 && b[i] > 0)) continue;
    difference += (a[i] - b[i]) ** 2;
    squares += b[i] ** 2;
    sumA += a[i];
    sumB += b[i];
  }
  return { rms: Math.sqrt(difference / squares), ratio: sumA / sumB };
}

/**
 * Returns a sky of radiance 1 that is brighter by `side` on one side; or a black one with a bright texel `at`
 * [x, y].
 */
function skyTexture({ side = 0.3, at } = {}) {
  const [columns, rows] = [128, 64];
  const data = new Float32Array(4 * columns * rows);
  for (let y = 0; y < rows; ++y)
    for (let x = 0; x < columns; ++x) {
      const soft = 1 + side * Math.sin((2 * Math.PI * x) / columns) * Math.sin((Math.PI * (y + 0.5)) / rows);
      const value = at ? (x === at[0] && y === at[1] ? 100 : 0) : soft;
      data.set([value, 0.7 * value, 0.5 * value, 1], 4 * (y * columns + x));
    }
  const texture = new DataTexture(data, columns, rows, RGBAFormat, FloatType, EquirectangularReflectionMapping);
  texture.flipY = true;
  return texture;
}

/** Returns the picture under prt's own sky, like `prt render` with exposure 1, as a data URL. */
async function likePrt({ model, sky, position, towards, fieldOfView }) {
  const [gltf, image] = await Promise.all([load(model), new EXRLoader().setDataType(FloatType).loadAsync(sky)]);
  const scene = new Scene().add(gltf.scene);
  scene.background = halfFloatSky(image, { center: "z" });
  gltf.userData.prtkit.setSky((await projectInWorker(image, gltf.userData.prtkit.order, { center: "z" })).deringed(), scene);
  return [...radiance(scene, cameraAt(position, towards, fieldOfView))];
}

/** Compares an unoccluded ball, with a reflected sky, lit by transfer and by three's environment. */
async function ball({ model, rotation, metalness, side }) {
  const gltf = await load(model);
  const scene = new Scene().add(gltf.scene);
  const sky = skyTexture({ side });
  scene.environment = halfFloatSky(sky);
  scene.environmentRotation.set(...rotation);
  const { prtkit } = gltf.userData;
  prtkit.setSky(await projectInWorker(sky, prtkit.order), scene);
  const camera = cameraAt([0, 1, 5], [0, 0, 0]);
  gltf.scene.traverse(({ material }) => material && (material.metalness = metalness));
  const lit = radiance(scene, camera);
  gltf.scene.rotation.set(0.5, 0.9, -0.3); // a sphere looks the same after rotation
  const rotated = compared(radiance(scene, camera), lit);
  scene.add(new AmbientLight(0xffffff, 3), new PointLight(0xffffff, 30).translateZ(3)); // their light must be in the sky or in lamps
  const others = compared(radiance(scene, camera), lit);
  gltf.scene.traverse((object) => {
    if (object.isMesh) object.material = new MeshStandardMaterial({ color: object.material.color, roughness: 1, metalness });
  });
  scene.clear().add(gltf.scene);
  return { own: compared(lit, radiance(scene, camera)), rotated, others };
}

/** Returns the middle pixel of a view along `direction` of a rotated background, which has one bright texel. */
async function inTheMiddle({ rotation, direction, at }) {
  const scene = new Scene();
  scene.background = halfFloatSky(skyTexture({ at }));
  scene.backgroundRotation.set(...rotation);
  const pixels = radiance(scene, cameraAt([0, 0, 0], direction, 10));
  return pixels[4 * ((height / 2) * width + width / 2)];
}

/** Compares instances with clones of the scene, at the same positions, with separate suns and fog. */
async function copies({ model }) {
  const gltf = await load(model);
  const { prtkit } = gltf.userData;
  const suns = [{ towards: [0.48, 0.6, 0.64], irradiance: [3, 2.5, 2], halfAngle: 0.005 }];
  const sky = await projectInWorker(skyTexture(), prtkit.order);
  const points = [-1.3, 1.3].map((x) => new Matrix4().makeTranslation(x, 0, 0));
  const camera = cameraAt([0, 3, 7], [0, 0, 0]);
  const show = (...objects) => {
    const scene = new Scene().add(...objects);
    const lights = new SunLights(suns, { mapSize: 512 }).fit(scene).follow(scene);
    scene.add(lights);
    prtkit.setSky(sky, scene, { suns: lightOfSuns(suns, prtkit.order) });
    return scene;
  };
  const instanced = [];
  gltf.scene.updateMatrixWorld(true);
  gltf.scene.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const copy = new InstancedMesh(mesh.geometry, mesh.material, points.length);
    points.forEach((point, i) => copy.setMatrixAt(i, point.clone().multiply(mesh.matrixWorld)));
    Object.assign(copy, { castShadow: mesh.castShadow, receiveShadow: mesh.receiveShadow });
    instanced.push(copy);
  });
  const clones = points.map((point) => {
    const clone = gltf.scene.clone();
    clone.applyMatrix4(point);
    clone.traverse((object) => object.isMesh && (object.material = object.material.clone()));
    return clone;
  });
  const [byInstances, scene] = [radiance(show(...instanced), camera), show(...clones)];
  const byClones = radiance(scene, camera);
  scene.traverse((object) => object.isDirectionalLight && (object.castShadow = false));
  const unshadowed = radiance(scene, camera);
  scene.fog = new Fog(0x0000ff, 0.1, 0.2); // opaque where the model is
  const [red, , blue] = radiance(scene, camera).reduce((sums, value, i) => ((sums[i % 4] += value), sums), [0, 0, 0, 0]);
  prtkit.dispose();
  return { instances: compared(byInstances, byClones), unshadowed: compared(unshadowed, byClones), fog: red / blue };
}

globalThis.game = { likePrt, ball, inTheMiddle, copies };
