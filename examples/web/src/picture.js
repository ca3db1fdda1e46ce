// What is on the canvas: a model, a sky, a camera. No panel here.

import {
  BackSide,
  BoxGeometry,
  CustomToneMapping,
  FloatType,
  LinearFilter,
  Mesh,
  NearestFilter,
  PerspectiveCamera,
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
import { PrtkitPlugin, projectEquirectangular } from "./PrtkitLoader.js";
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

export class Picture {
  constructor(canvas) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.toneMapping = CustomToneMapping;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(35, 1, 0.01, 100);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.background = new Mesh(
      new BoxGeometry(2, 2, 2),
      new ShaderMaterial({
        vertexShader: backgroundVertex,
        fragmentShader: backgroundFragment,
        uniforms: { environment: { value: null }, angle: { value: 0 } },
        side: BackSide,
        depthWrite: false,
      }),
    );
    this.background.frustumCulled = false;
    this.background.renderOrder = -1;
    this.background.visible = false;
    this.scene.add(this.background);
    this.gltf = null;
    this.light = null;
    this.angle = 0;
    this.stops = 0;
    this.drawn = 0;
    this.pending = false;
  }

  /** Shows the model at `url`; the camera stays where a model was shown before and `keepCamera` is set. */
  async setModel(url, { keepCamera = false, camera } = {}) {
    const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).register((parser) => new PrtkitPlugin(parser));
    const gltf = await loader.loadAsync(url);
    if (!gltf.userData.prtkit) throw new Error(`${url} holds no PRTKIT_clustered_pca: run prt bake and prt compress`);
    this.removeModel();
    this.gltf = gltf;
    this.scene.add(gltf.scene);
    if (!keepCamera) this.frame(camera);
    this.relight();
  }

  removeModel() {
    if (!this.gltf) return;
    this.scene.remove(this.gltf.scene);
    this.gltf.scene.traverse((object) => {
      object.geometry?.dispose();
      object.material?.map?.dispose();
      object.material?.dispose();
    });
    this.gltf.userData.prtkit.dispose();
    this.gltf = null;
  }

  async setSky(url) {
    const exr = /\.exr(\?|$)/.test(url);
    const texture = await (exr ? new EXRLoader() : new HDRLoader()).setDataType(FloatType).loadAsync(url);
    texture.minFilter = texture.magFilter = this.renderer.extensions.has("OES_texture_float_linear")
      ? LinearFilter
      : NearestFilter;
    texture.generateMipmaps = false;
    this.background.material.uniforms.environment.value?.dispose();
    this.background.material.uniforms.environment.value = texture;
    this.background.visible = true;
    this.light = projectEquirectangular(texture);
    this.relight();
  }

  setAngle(radians) {
    this.angle = radians;
    this.relight();
  }

  setExposure(stops) {
    this.stops = stops;
    this.relight();
  }

  relight() {
    if (!this.light) return;
    this.background.material.uniforms.angle.value = this.angle;
    this.renderer.toneMappingExposure = (0.25 / this.light.meanLuminance()) * 2 ** this.stops;
    this.gltf?.userData.prtkit.setLight(this.light, this.angle);
    this.draw();
  }

  /** From the front, a little from the right and above; or `camera`: { position, target, fieldOfView }. */
  frame(camera) {
    const corner = { low: new Vector3(Infinity, Infinity, Infinity), high: new Vector3(-Infinity, -Infinity, -Infinity) };
    this.gltf.scene.updateMatrixWorld(true);
    this.gltf.scene.traverse((object) => {
      if (!object.isMesh) return;
      object.geometry.computeBoundingBox();
      const box = object.geometry.boundingBox.clone().applyMatrix4(object.matrixWorld);
      corner.low.min(box.min);
      corner.high.max(box.max);
    });
    const centre = corner.low.clone().add(corner.high).multiplyScalar(0.5);
    const radius = corner.low.distanceTo(corner.high) / 2;
    this.camera.fov = camera?.fieldOfView ?? 35;
    this.camera.near = radius / 100;
    this.camera.far = radius * 20;
    this.controls.target.fromArray(camera?.target ?? centre.toArray());
    const from = new Vector3(0.45, 0.35, 1).normalize();
    const distance = radius / Math.sin((0.5 * this.camera.fov * Math.PI) / 180);
    this.camera.position.fromArray(camera?.position ?? from.multiplyScalar(distance).add(centre).toArray());
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  resize(width, height, pixelRatio) {
    this.renderer.setPixelRatio(pixelRatio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Once, before the browser shows the next frame. */
  draw() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.renderer.render(this.scene, this.camera);
      if (this.gltf && this.light) ++this.drawn;
    });
  }
}
