// Draws test models with WebGLRenderer and WebGPURenderer, and reads back other results of the plug-in, as
// renderers.mjs requests.
import {
  ACESFilmicToneMapping,
  AmbientLight,
  Bone,
  DataTexture,
  DirectionalLight,
  EquirectangularReflectionMapping,
  Float32BufferAttribute,
  FloatType,
  Fog,
  Group,
  InstancedMesh,
  LightProbe,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  MeshPhysicalMaterial,
  MeshStandardMaterial,
  OrthographicCamera,
  PCFShadowMap,
  PerspectiveCamera,
  PlaneGeometry,
  PointLight,
  RGBAFormat,
  Scene,
  Skeleton,
  SkinnedMesh,
  SphereGeometry,
  SphericalHarmonics3,
  Uint16BufferAttribute,
  WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { WebGPURenderer } from "three/webgpu";
import { halfFloatSky, lightFromProbe, PrtkitPlugin, PrtkitVolume, ShLight } from "../../src/PrtkitLoader.js";
import { PrtkitPlugin as NodePlugin } from "../../src/webgpu.js";

const renderer = new WebGLRenderer({ antialias: false });
renderer.setSize(64, 48, false);

const load = (url, Plugin = PrtkitPlugin) => new GLTFLoader().register((parser) => new Plugin(parser)).loadAsync(url);

function camera() {
  const seen = new PerspectiveCamera(40, 4 / 3, 0.1, 20);
  seen.position.set(1.5, 3, 5);
  seen.lookAt(0, 0.4, 0);
  return seen;
}

/** Returns the bytes of a texture on the device. */
function bytesOf(texture, { width, height }) {
  const gl = renderer.getContext();
  const frame = gl.createFramebuffer();
  const bytes = new Uint8Array(4 * width * height);
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, renderer.properties.get(texture).__webglTexture, 0);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  gl.deleteFramebuffer(frame);
  renderer.resetState();
  return [...bytes];
}

function pixelsBy(drawing, target) {
  const { width, height, texture } = target;
  const pixels = new (texture.type === FloatType ? Float32Array : Uint16Array)(4 * width * height);
  drawing.readRenderTargetPixels(target, 0, 0, width, height, pixels);
  return [...pixels];
}
const pixelsOf = (target) => pixelsBy(renderer, target);

/**
 * Returns the bytes of the words of a model with lightmaps, and the radiance of its texels, in half floats
 * and in floats.
 */
async function texels({ model, light, lamps }) {
  const { scene, userData } = await load(model);
  const { prtkit } = userData;
  let drawn = 0;
  const { pass } = prtkit.maps;
  const draw = pass.draw.bind(pass);
  pass.draw = (...options) => (++drawn, draw(...options));
  prtkit.setLight(ShLight.fromCoefficients(prtkit.order, light), 0, null, lamps);
  const shown = new Scene().add(scene);
  const drawnOnce = () => {
    const target = new WebGLRenderTarget(64, 48, { type: FloatType });
    renderer.setRenderTarget(target);
    renderer.render(shown, camera());
    renderer.setRenderTarget(null);
    return pixelsOf(target);
  };
  const first = drawnOnce();
  const [once, second] = [drawn, drawnOnce()];
  const maps = prtkit.maps.maps.map((map, i) => {
    const { target } = [...prtkit.maps.targets.values()].find((other) => other.map === map);
    const floats = new WebGLRenderTarget(map.width, map.height, { type: FloatType, depthBuffer: false });
    draw(renderer, floats, map);
    return { i, bytes: map.words.map((texture) => bytesOf(texture, map)), halves: pixelsOf(target), floats: pixelsOf(floats) };
  });
  const unchanged = drawn;
  prtkit.setLight(ShLight.fromCoefficients(prtkit.order, light.map((value) => 2 * value)), 0, null, lamps);
  drawnOnce();
  const doubled = pixelsOf([...prtkit.maps.targets.values()][0].target);
  prtkit.dispose();
  const again = drawnOnce(); // disposed objects are created again
  return {
    targets: prtkit.maps.targets.size,
    once,
    unchanged,
    afterChange: drawn,
    maps,
    doubled,
    same: first.every((value, k) => value === second[k]) && first.some((value) => value > 0.1 && value !== 1),
    again: again.some((value) => value > 0.1 && value !== 1),
  };
}

const [columns, rows] = [320, 240];
const renderers = new Map();

/** Creates WebGLRenderer ("webgl"), or WebGPURenderer on WebGL ("nodes") or on WebGPU ("webgpu"). */
async function rendererOf(api) {
  if (!renderers.has(api)) {
    const made = api === "webgl" ? new WebGLRenderer({ antialias: false }) : new WebGPURenderer({ antialias: false, forceWebGL: api === "nodes" });
    await made.init?.();
    if (api === "webgpu" && !made.backend.isWebGPUBackend) throw new Error("WebGPU is missing");
    made.setSize(columns, rows, false);
    made.toneMapping = ACESFilmicToneMapping;
    made.toneMappingExposure = 0.5;
    made.shadowMap.enabled = true;
    made.shadowMap.type = PCFShadowMap;
    renderers.set(api, made);
  }
  return renderers.get(api);
}

function evenSky() {
  const data = new Float32Array(4 * 64 * 32);
  for (let y = 0; y < 32; ++y)
    for (let x = 0; x < 64; ++x) {
      const value = 1 + 0.5 * Math.sin((2 * Math.PI * x) / 64) * Math.sin((Math.PI * (y + 0.5)) / 32);
      data.set([value, 0.8 * value, 0.6 * value, 1], 4 * (y * 64 + x));
    }
  const texture = new DataTexture(data, 64, 32, RGBAFormat, FloatType, EquirectangularReflectionMapping);
  texture.flipY = true;
  return halfFloatSky(texture);
}

const PLACES = [[-0.6, 0, -0.5], [0.9, 0.3, 0.6]];

/** Returns instances of all meshes, at each of the positions. */
function instancesOf(root) {
  const instances = [];
  root.updateMatrixWorld(true);
  root.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const copy = new InstancedMesh(mesh.geometry, mesh.material, PLACES.length);
    PLACES.forEach((point, i) => copy.setMatrixAt(i, new Matrix4().makeTranslation(...point).multiply(mesh.matrixWorld)));
    instances.push(Object.assign(copy, { castShadow: mesh.castShadow, receiveShadow: mesh.receiveShadow }));
  });
  return instances;
}

const clonesOf = (root) =>
  PLACES.map((point) => {
    const clone = root.clone();
    clone.position.set(...point);
    clone.traverse((object) => object.isMesh && (object.material = object.material.clone()));
    return clone;
  });

function probe() {
  const made = new LightProbe(new SphericalHarmonics3(), 0.8);
  made.sh.coefficients.forEach((coefficient, i) => coefficient.set(1 / (1 + i), 0.8 / (1 + i), 0.5));
  return made;
}

/** Returns a scene with the model in the requested light. */
async function sceneOf(api, { model, light, environment, suns, shadows, fog, others, change, copies, besides, probed, wrong }) {
  const Plugin = (api === "webgl") !== Boolean(wrong) ? PrtkitPlugin : NodePlugin;
  const gltf = await load(model, Plugin);
  const scene = new Scene();
  if (copies === "instances") scene.add(...instancesOf(gltf.scene));
  else if (copies === "clones") scene.add(...clonesOf(gltf.scene));
  else scene.add(gltf.scene);
  if (besides) {
    const other = await load(besides, Plugin);
    other.scene.position.set(0.3, 1, 0.2);
    other.scene.scale.setScalar(0.5);
    other.userData.prtkit.setLight(ShLight.fromCoefficients(2, light.map((value, i) => (i % 3 === 0 ? 0.2 : 0.6) * value)));
    scene.add(other.scene);
  }
  if (environment) scene.environment = evenSky();
  if (fog) scene.fog = new Fog(0x8090a0, 3, 9);
  if (others) scene.add(new AmbientLight(0xffffff, 2), new PointLight(0xffffff, 40).translateY(3));
  if (suns) {
    const sun = new DirectionalLight(0xffeedd, 2);
    sun.position.set(2, suns === "from below" ? -4 : 4, 1.5);
    sun.castShadow = Boolean(shadows);
    Object.assign(sun.shadow.camera, { left: -4, right: 4, bottom: -4, top: 4, near: 0.1, far: 12 });
    sun.shadow.camera.updateProjectionMatrix();
    sun.shadow.mapSize.set(512, 512);
    if (suns !== "own") Object.assign(sun.shadow, { bias: -0.002, normalBias: 0.02 });
    scene.add(sun);
  }
  const { prtkit } = gltf.userData;
  const { order } = prtkit.volume ?? prtkit;
  const sky = ShLight.fromCoefficients(order, [...light, ...new Array(3 * order * order - light.length).fill(0)]);
  if (change === "moving") {
    const coated = new MeshPhysicalMaterial({ color: 0xcc8844, metalness: 0.5, roughness: 0.3, clearcoat: 1, clearcoatRoughness: 0.1 });
    scene.add(prtkit.volume.light(new Mesh(new SphereGeometry(0.6, 32, 24), coated).translateY(1.4).translateX(-0.5)));
  }
  if (probed) {
    scene.environmentRotation.y = scene.backgroundRotation.y = 0.7;
    prtkit.setSky(lightFromProbe(probe(), prtkit.order), scene);
  } else if (suns === "own") prtkit.setSky(sky, scene, { suns: scene.children.filter(({ isDirectionalLight }) => isDirectionalLight) });
  else prtkit.setLight(sky, 0.3, suns ? sky.times(0.1) : null, besides ? { Lantern: 0 } : {});
  if (change === "clone") gltf.scene.traverse((object) => object.isMesh && (object.material = object.material.clone()));
  if (change === "three's own")
    gltf.scene.traverse((object) => {
      if (!object.isMesh) return;
      const { color, lightMap, lightMapIntensity } = object.material;
      object.onBeforeRender = prtkit.beforeRender;
      object.material = new MeshStandardMaterial({ color, lightMap, lightMapIntensity, metalness: 0 });
    });
  if (change === "alone")
    gltf.scene.traverse((object) => {
      if (!object.isMesh) return;
      const { color, roughness, side } = object.material;
      object.onBeforeRender = () => {};
      object.material = new MeshStandardMaterial({ color, roughness, side, metalness: 0 });
    });
  if (change === "matte") gltf.scene.traverse((object) => object.isMesh && Object.assign(object.material, { metalness: 0, clearcoat: 0 }).emissive.set(0));
  if (change === "metal") gltf.scene.traverse((object) => object.isMesh && (object.material.metalness = 1));
  return { scene, prtkit };
}

/** Returns the pixels of the canvas, red, green, blue and alpha. */
async function picture({ api, ...asked }) {
  const drawing = await rendererOf(api);
  const { scene, prtkit } = await sceneOf(api, asked);
  drawing.render(scene, camera());
  const sheet = new OffscreenCanvas(columns, rows).getContext("2d");
  sheet.drawImage(drawing.domElement, 0, 0);
  prtkit.dispose();
  return [...sheet.getImageData(0, 0, columns, rows).data];
}

/** Draws the scene as radiance without a tone curve, in sRGB of 0 to 255, and without a canvas. */
async function radiance({ api, ...asked }) {
  const drawing = await rendererOf(api);
  const { scene, prtkit } = await sceneOf(api, asked);
  const target = new WebGLRenderTarget(columns, rows, { type: FloatType });
  drawing.setRenderTarget(target);
  drawing.render(scene, camera());
  const floats = drawing.isWebGLRenderer
    ? pixelsBy(drawing, target)
    : await drawing.readRenderTargetPixelsAsync(target, 0, 0, columns, rows);
  drawing.setRenderTarget(null);
  prtkit.dispose();
  const row = (y) => (api === "webgpu" ? y : rows - 1 - y); // OpenGL has the last row first
  const encoded = (v) => 255 * Math.min(1, v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
  return Array.from({ length: 4 * columns * rows }, (_, i) => {
    const [y, rest] = [Math.floor(i / (4 * columns)), i % (4 * columns)];
    return i % 4 === 3 ? 255 : encoded(0.5 * floats[row(y) * 4 * columns + rest]);
  });
}

/** Returns the half floats of the maps of a model after the first picture of WebGPURenderer. */
async function nodeTexels({ api, ...asked }) {
  const drawing = await rendererOf(api);
  const { scene, prtkit } = await sceneOf(api, asked);
  let drawn = 0;
  const { pass } = prtkit.maps;
  const draw = pass.draw.bind(pass);
  pass.draw = (...options) => (++drawn, draw(...options));
  drawing.setRenderTarget(new WebGLRenderTarget(columns, rows));
  for (let i = 0; i < 2; ++i) drawing.render(scene, camera());
  drawing.setRenderTarget(null);
  const maps = [];
  for (const [i, map] of prtkit.maps.maps.entries()) {
    const { target } = [...prtkit.maps.targets.values()].find((other) => other.map === map);
    maps.push({ i, halves: [...(await drawing.readRenderTargetPixelsAsync(target, 0, 0, map.width, map.height))] });
  }
  prtkit.dispose();
  return { maps, drawn };
}

/** Returns a square about the origin that faces +Z, as each kind of moving object. */
function squares(kind, material) {
  const geometry = new PlaneGeometry(2, 2);
  if (kind === "instances") {
    const mesh = new InstancedMesh(geometry, material, 1);
    mesh.setMatrixAt(0, new Matrix4().makeTranslation(0, 0, 0.25));
    mesh.position.z = -0.25;
    return mesh;
  }
  if (kind === "morphed") {
    geometry.morphAttributes.position = [new Float32BufferAttribute(new Array(4).fill([0, 0, 0.5]).flat(), 3)];
    geometry.morphTargetsRelative = true;
    const mesh = new Mesh(geometry, material);
    mesh.morphTargetInfluences[0] = 0.5;
    mesh.position.z = -0.25;
    return mesh;
  }
  if (kind !== "skinned") return new Mesh(geometry, material);
  geometry.setAttribute("skinIndex", new Uint16BufferAttribute(new Array(16).fill(0), 4));
  geometry.setAttribute("skinWeight", new Float32BufferAttribute(new Array(4).fill([1, 0, 0, 0]).flat(), 4));
  const bone = new Bone();
  const mesh = new SkinnedMesh(geometry, material);
  mesh.add(bone);
  mesh.bind(new Skeleton([bone], [new Matrix4()]));
  bone.position.z = 0.25;
  mesh.position.z = -0.25;
  return mesh;
}

const MATERIALS = {
  matte: () => new MeshLambertMaterial({ color: 0xffffff, reflectivity: 0 }),
  chrome: () => new MeshStandardMaterial({ color: 0xffffff, metalness: 1, roughness: 0 }),
};

/**
 * Returns the radiance of a square lit by a volume: floats from the bottom row up, red, green, blue and
 * alpha, without a tone curve. The square is a `kind` of mesh, 2 metres wide, at position `point` with
 * rotation `rotation` (Euler angles); the camera looks at it along its normal.
 */
async function lit({ api = "webgl", model, floats, kind, material, point, rotation, light, lamps, moved, size: [width, height] }) {
  const drawing = await rendererOf(api);
  const gltf = await load(model, api === "webgl" ? PrtkitPlugin : NodePlugin);
  let { volume } = gltf.userData.prtkit;
  if (floats) volume = new PrtkitVolume(volume.source, gltf.scene, volume.plugin, { floats });
  volume.setLight(ShLight.fromCoefficients(volume.order, light), 0, null, lamps);
  const holder = new Group();
  holder.add(squares(kind, MATERIALS[material]()));
  holder.position.fromArray(point);
  holder.rotation.fromArray(rotation);
  const seen = new OrthographicCamera(-1, 1, 1, -1, 0.1, 10);
  seen.position.z = 2;
  holder.add(seen);
  const around = new Group().add(holder);
  const scene = new Scene().add(gltf.scene, around);
  for (const root of moved ? [gltf.scene, around] : []) {
    root.position.fromArray(moved.point); // with all its children
    root.rotation.fromArray(moved.rotation);
  }
  volume.light(holder);
  const target = new WebGLRenderTarget(width, height, { type: FloatType });
  drawing.setRenderTarget(target);
  drawing.render(scene, seen);
  const pixels = drawing.isWebGLRenderer ? pixelsBy(drawing, target) : await drawing.readRenderTargetPixelsAsync(target, 0, 0, width, height);
  drawing.setRenderTarget(null);
  volume.dispose();
  return [...pixels];
}

/**
 * Returns floats of a model's floor from above, 2 metres wide about `centre`, without and with the passing
 * object. `moved` contains position, rotation and scale of each child of `passer`.
 */
async function occluded({ model, passer, moved, centre, size: [width, height], light }) {
  const drawing = await rendererOf("webgl");
  const [gltf, passing] = [await load(model), await load(passer)];
  const { prtkit } = gltf.userData;
  prtkit.setLight(ShLight.fromCoefficients(prtkit.order, light));
  const floor = gltf.scene.children[0];
  passing.scene.children.forEach((child, i) => {
    child.position.fromArray(moved[i].point);
    child.rotation.fromArray(moved[i].rotation);
    child.scale.setScalar(moved[i].scale);
  });
  const scene = new Scene().add(floor, passing.scene);
  const seen = new OrthographicCamera(-1, 1, 1, -1, 0.1, 10);
  seen.position.set(centre[0], 5, centre[1]);
  seen.rotation.x = -Math.PI / 2;
  const target = new WebGLRenderTarget(width, height, { type: FloatType });
  const pictures = [null, passing.userData.prtkitOccluders, null].map((occluders) => {
    prtkit.setOccluders(occluders);
    drawing.setRenderTarget(target);
    drawing.render(scene, seen);
    drawing.setRenderTarget(null);
    return pixelsBy(drawing, target);
  });
  prtkit.dispose();
  return pictures;
}

/**
 * Returns floats of a figure with lobes in a pose, from the front, 2 metres wide, from the bottom row up.
 * `pose`: Euler angles of its bones; `rotation`: rotation of the figure; `volume`: a file whose volume lights it;
 * default: the sky.
 */
async function posed({ model, volume, pose, rotation, light, size: [width, height] }) {
  const drawing = await rendererOf("webgl");
  const { scene: figure, userData } = await load(model);
  const { prtkit } = userData;
  ["one", "other"].forEach((name, i) => figure.getObjectByName(name).rotation.fromArray(pose[i]));
  const scene = new Scene().add(new Group().add(figure));
  scene.children[0].rotation.fromArray(rotation);
  if (volume) {
    const around = await load(volume);
    const own = around.userData.prtkit.volume;
    const exact = new PrtkitVolume(own.source, around.scene, own.plugin, { floats: true });
    exact.setLight(ShLight.fromCoefficients(exact.order, light));
    own.light(figure); // a second volume takes over
    exact.light(figure);
  } else prtkit.setSky(ShLight.fromCoefficients(prtkit.order, light), scene);
  const seen = new OrthographicCamera(-1, 1, 1, -1, 0.1, 10);
  seen.position.z = 5;
  const target = new WebGLRenderTarget(width, height, { type: FloatType });
  drawing.setRenderTarget(target);
  drawing.render(scene, seen);
  drawing.setRenderTarget(null);
  prtkit.dispose();
  return pixelsBy(drawing, target);
}

globalThis.pictures = { texels, picture, radiance, nodeTexels, lit, occluded, posed };
