// The content of the canvas: a model, a sky, a camera. Does not include the panel.

import {
  AnimationMixer,
  BackSide,
  BasicShadowMap,
  Box3,
  BoxGeometry,
  CustomToneMapping,
  FloatType,
  LinearFilter,
  Mesh,
  NearestFilter,
  PerspectiveCamera,
  RepeatWrapping,
  Scene,
  ShaderChunk,
  ShaderMaterial,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { EXRLoader } from "three/examples/jsm/loaders/EXRLoader.js";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { HDRLoader } from "three/examples/jsm/loaders/HDRLoader.js";
import { MeshoptDecoder } from "three/examples/jsm/libs/meshopt_decoder.module.js";
import { Moving } from "./moving.js";
import { halfFloatSky, lightOfSuns, PrtkitPlugin, projectInWorker, readLightFile, SunLights } from "prtkit-web";
import { skyImage } from "./skyImage.js";
import { truncated, WINDOWS } from "./windows.js";
import { ExposureMeter } from "./exposureMeter.js";
import backgroundFragment from "./background.frag?raw";
import backgroundVertex from "./background.vert?raw";

// The tone curve of `prt render`: Narkowicz's fit to the ACES curve (2016).
ShaderChunk.tonemapping_pars_fragment = ShaderChunk.tonemapping_pars_fragment.replace(
  "vec3 CustomToneMapping( vec3 color ) { return color; }",
  `vec3 CustomToneMapping(vec3 color) {
    vec3 x = min(color * toneMappingExposure, vec3(1e4));
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
  }`,
);

async function loadLightFile(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return readLightFile(await response.json());
}

/** Loads a model and its transfer; throws if it has no compressed transfer. `progress`: see three's loaders. */
async function loadModel(url, progress) {
  const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).register((parser) => new PrtkitPlugin(parser));
  const gltf = await loader.loadAsync(url, progress);
  if (gltf.userData.prtkit) return gltf;
  disposeOf(gltf);
  throw new Error("the file has no transfer: run prt bake and prt compress, or prt make");
}

function disposeOf(gltf) {
  gltf.scene.traverse(({ geometry, material }) => {
    geometry?.dispose();
    for (const value of Object.values(material ?? {})) if (value?.isTexture) value.dispose();
    material?.dispose();
  });
  gltf.userData.prtkit?.dispose();
}

/** Returns the animation with that name, or the first, of a figure; null if it has none. */
function danceOf({ scene, animations }, name) {
  const clip = animations.find((animation) => animation.name === name) ?? animations[0];
  if (!clip) return null;
  const mixer = new AnimationMixer(scene);
  mixer.clipAction(clip).play();
  return mixer;
}

export class Picture {
  /** `shadowMapSize`: texels along each side. */
  constructor(canvas, { shadowMapSize = 2048 } = {}) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.toneMapping = CustomToneMapping;
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.shadowMap.enabled = true;
    // relit materials filter it according to the size of the sun
    this.renderer.shadowMap.type = BasicShadowMap;
    this.meter = new ExposureMeter(this.renderer);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(35, 1, 0.01, 100);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.fieldOfView = 35; // degrees, along the shorter side
    this.background = new Mesh(
      new BoxGeometry(2, 2, 2),
      new ShaderMaterial({
        vertexShader: backgroundVertex,
        fragmentShader: backgroundFragment,
        uniforms: { environment: { value: null }, angle: { value: 0 }, middle: { value: 0 }, strength: { value: 1 } },
        side: BackSide,
        depthWrite: false,
      }),
    );
    this.background.frustumCulled = false;
    this.background.renderOrder = -1;
    this.background.visible = false;
    this.scene.add(this.background);
    this.moving = new Moving(this.scene);
    this.movedAt = null; // time of the previous picture, milliseconds
    this.isMetered = false; // true if the exposure fits the current light and camera
    this.gltf = null;
    this.before = null; // the model before compression
    this.split = 0.5; // the model before compression is on the left; fraction of the width
    this.shine = false; // whether materials reflect the sky
    this.light = null; // light of the sky with its suns, all bands
    this.sunny = null; // the sky without its suns, and the suns, if there is a light file
    this.sunLights = null;
    this.shadowMapSize = shadowMapSize;
    this.separateSuns = true; // if there are suns, and the model supports separate ones
    this.window = "auto";
    // light of the model: { sky, suns }, with the model's order, the sky filtered by the window
    this.lit = null;
    this.angle = 0;
    this.daylight = 1; // factor on the sky and its suns
    this.lamps = {}; // strengths by name
    this.stops = 0;
    this.still = false; // the figure does not walk
    this.dance = null; // animation of a model with lobes
    this.drawn = 0;
    this.pending = false;
  }

  /**
   * Shows the model at `url`; the camera is kept if a model was shown before and `keepCamera` is set. `way`:
   * see Walk; `clip`: name of the animation of a model with lobes.
   */
  async setModel(url, { keepCamera = false, camera, way, clip, progress } = {}) {
    const gltf = await loadModel(url, progress);
    this.removeModel();
    this.gltf = gltf;
    this.lamps = {};
    this.scene.add(gltf.scene);
    if (!keepCamera) this.frame(camera);
    this.moving.enter(gltf, way);
    this.dance = gltf.userData.prtkit.lobes ? danceOf(gltf, clip) : null;
    this.updateLight();
  }

  /** Shows or hides "figure", "spheres" or "probes". */
  setMoving(part, shown) {
    this.moving.show(part, shown);
    this.updateShadows();
    this.draw();
  }

  updateShadows() {
    for (const { shadow } of this.sunLights?.lights ?? []) shadow.needsUpdate = true;
  }

  /** Shows the model at `url`, the current model before compression, left of `split`; null: not shown. */
  async setBefore(url, progress) {
    const gltf = url ? await loadModel(url, progress) : null;
    this.removeBefore();
    this.before = gltf;
    if (gltf) this.scene.add(gltf.scene);
    this.relight();
  }

  /** Sets the split as a fraction of the width. */
  setSplit(share) {
    this.split = share;
    this.draw();
  }

  removeBefore() {
    if (!this.before) return;
    this.scene.remove(this.before.scene);
    disposeOf(this.before);
    this.before = null;
  }

  removeModel() {
    this.removeBefore();
    if (!this.gltf) return;
    this.scene.remove(this.gltf.scene);
    disposeOf(this.gltf);
    this.gltf = null;
  }

  /**
   * `file`: a lat-long sky; `center` is the axis that its middle faces: "x" as in three, "z" as in OpenEXR.
   * `light`: its light file, with its suns. At least one of both is required.
   */
  async setSky({ file, exr = /\.exr(\?|$)/.test(file), center = "x", light }, progress) {
    const [image, split] = await Promise.all([
      file ? (exr ? new EXRLoader() : new HDRLoader()).setDataType(FloatType).loadAsync(file, progress) : null,
      light ? loadLightFile(light) : null,
    ]);
    this.light = image
      ? await projectInWorker(image, undefined, { center })
      : split.sky.plus(lightOfSuns(split.suns, split.sky.order));
    this.showSky(image ?? skyImage(split.sky.deringed()), image ? center : "z");
    this.setSuns(split);
    this.updateLight();
  }

  showSky(texture, center) {
    texture.minFilter = texture.magFilter = this.renderer.extensions.has("OES_texture_float_linear")
      ? LinearFilter
      : NearestFilter;
    texture.wrapS = RepeatWrapping;
    texture.generateMipmaps = false;
    const { environment, middle } = this.background.material.uniforms;
    environment.value?.dispose();
    environment.value = texture;
    this.center = center;
    this.setShine(this.shine);
    middle.value = center === "x" ? 0.75 : 0.5;
    this.background.visible = true;
  }

  /** Sets whether materials reflect the sky as in three; diffuse light comes from transfer in both cases. */
  setShine(shine) {
    this.shine = shine;
    this.scene.environment?.dispose();
    const { value: sky } = this.background.material.uniforms.environment;
    this.scene.environment = shine && sky ? halfFloatSky(sky, { center: this.center }) : null;
    this.draw();
  }

  /** `split`: content of a light file, or null. */
  setSuns(split) {
    this.sunLights?.removeFromParent();
    this.sunLights?.dispose();
    this.sunLights = null;
    this.sunny = split?.suns.length > 0 ? split : null;
    if (!this.sunny) return;
    this.sunLights = new SunLights(split.suns, { mapSize: this.shadowMapSize });
    for (const { shadow } of this.sunLights.lights) shadow.autoUpdate = false; // only the suns move
    this.scene.add(this.sunLights);
  }

  /** Sets whether suns are separate, with sharp shadows, or part of the sky. */
  setSeparateSuns(separate) {
    this.separateSuns = separate;
    this.updateLight();
  }

  /** True if suns can be separate: the sky has suns, and the model has a separate direct term. */
  get canSeparateSuns() {
    const model = this.gltf?.userData.prtkit;
    return Boolean(this.sunny && model?.hasDirectTerm && this.sunny.sky.order >= model.order);
  }

  /** Sets one of WINDOWS. */
  setWindow(name) {
    this.window = name;
    this.updateLight();
  }

  /** Computes the light, once for each sky and model: rotation does not change the effect of the window. */
  updateLight() {
    const { order } = this.gltf?.userData.prtkit ?? {};
    if (this.light && order) {
      const separate = this.separateSuns && this.canSeparateSuns;
      const sky = WINDOWS[this.window].apply(truncated(separate ? this.sunny.sky : this.light, order));
      this.lit = { sky, suns: separate ? lightOfSuns(this.sunny.suns, order) : null };
      if (this.sunLights) this.sunLights.visible = separate;
      if (separate) this.sunLights.fit(this.gltf.scene);
    }
    this.relight();
  }

  setAngle(radians) {
    this.angle = radians;
    this.relight();
  }

  /** Sets the factor on the sky and its suns. */
  setDaylight(factor) {
    this.daylight = factor;
    this.relight();
  }

  setLamp(name, strength) {
    this.lamps[name] = strength;
    this.relight();
  }

  setExposure(stops) {
    this.stops = stops;
    this.relight();
  }

  relight() {
    if (!this.light) return;
    const { uniforms } = this.background.material;
    uniforms.angle.value = this.angle;
    uniforms.strength.value = this.daylight;
    this.scene.environmentRotation.y = this.angle;
    this.scene.environmentIntensity = this.daylight;
    if (this.gltf && this.lit) {
      const { sky, suns } = this.lit;
      for (const { userData } of this.before ? [this.gltf, this.before] : [this.gltf])
        userData.prtkit.setLight(sky.times(this.daylight), this.angle, suns?.times(this.daylight) ?? null, this.lamps);
    }
    this.sunLights?.rotate(this.angle).dim(this.daylight);
    this.draw();
  }

  /**
   * Sets the camera in front, slightly to the right and above; or to `camera`: { position, target,
   * fieldOfView }.
   */
  frame(camera) {
    this.gltf.scene.updateMatrixWorld(true);
    const box = new Box3().setFromObject(this.gltf.scene);
    const centre = box.getCenter(new Vector3());
    const radius = box.min.distanceTo(box.max) / 2;
    this.fieldOfView = camera?.fieldOfView ?? 35;
    this.camera.near = radius / 100;
    this.camera.far = radius * 20;
    this.controls.target.fromArray(camera?.target ?? centre.toArray());
    const from = new Vector3(0.45, 0.35, 1).normalize();
    const distance = radius / Math.sin((0.5 * this.fieldOfView * Math.PI) / 180);
    this.camera.position.fromArray(camera?.position ?? from.multiplyScalar(distance).add(centre).toArray());
    this.fitFieldOfView();
    this.controls.update();
  }

  resize(width, height, pixelRatio) {
    this.renderer.setPixelRatio(pixelRatio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(1, height);
    this.fitFieldOfView();
    this.draw();
  }

  /** Applies the field of view to the shorter side: on a phone the model fits the width. */
  fitFieldOfView() {
    const half = Math.tan((0.5 * this.fieldOfView * Math.PI) / 180);
    this.camera.fov = (2 * Math.atan(half / Math.min(1, this.camera.aspect)) * 180) / Math.PI;
    this.camera.updateProjectionMatrix();
  }

  /** Measures the exposure of the model without moving objects, so that it does not change when they move. */
  expose() {
    if (this.isMetered) return;
    this.isMetered = true;
    const { visible } = this.background;
    this.background.visible = this.moving.group.visible = false;
    if (this.before) [this.before.scene.visible, this.gltf.scene.visible] = [false, true];
    const metered = this.meter.exposure(this.scene, this.camera);
    this.background.visible = visible;
    this.moving.group.visible = true;
    this.renderer.toneMappingExposure = (metered ?? 0.25 / this.light.meanLuminance()) * 2 ** this.stops;
  }

  /** Draws once, before the browser shows the next frame. */
  draw() {
    this.isMetered = false;
    this.drawSoon();
  }

  drawSoon() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame((now) => {
      this.pending = false;
      this.move(now);
      if (this.gltf && this.light) this.expose();
      this.render();
      if (this.gltf && this.light) ++this.drawn;
      if (this.gltf && this.light && (this.isMoving || this.moving.isWaiting)) this.drawSoon();
    });
  }

  /** True if the picture is animated. */
  get isMoving() {
    return (this.moving.isWalking || this.dance !== null) && !this.still;
  }

  /** Advances the animation; a slow frame or a hidden page does not cause a jump. */
  move(now) {
    if (this.isMoving && this.movedAt !== null) {
      const seconds = Math.min((now - this.movedAt) / 1000, 0.1);
      if (this.moving.isWalking) this.moving.advance(seconds);
      this.dance?.update(seconds);
      this.updateShadows();
    }
    this.movedAt = this.isMoving ? now : null;
  }

  /** Draws the whole picture, or the model before compression on the left and after it on the right. */
  render() {
    const { renderer, before, gltf } = this;
    if (!before || !gltf) return renderer.render(this.scene, this.camera);
    const [width, height] = [renderer.domElement.clientWidth, renderer.domElement.clientHeight];
    const middle = Math.round(this.split * width);
    renderer.setScissorTest(true);
    for (const [shown, hidden, x, columns] of [[before, gltf, 0, middle], [gltf, before, middle, width - middle]]) {
      [shown.scene.visible, hidden.scene.visible] = [true, false];
      renderer.setScissor(x, 0, columns, height);
      renderer.render(this.scene, this.camera);
    }
    renderer.setScissorTest(false);
  }
}
