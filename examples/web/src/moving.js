// Moving objects lit by the volume of the scene: a walking figure, two spheres to evaluate the light, and the
// probes.

import {
  AnimationMixer,
  Group,
  IcosahedronGeometry,
  InstancedMesh,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  SphereGeometry,
} from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { PrtkitPlugin } from "prtkit-web";
import { Walk } from "./walk.js";

const RADIUS = 0.25; // metres
const ASIDE = 0.75; // distance from the figure, on both sides
const HIGH = 1.2; // metres above the ground
const PROBE_SHARE = 0.06; // fraction of the minimum distance of probes
const USUAL_SPEED = 1.2; // metres per second

function ball(color, metalness, roughness) {
  return new Mesh(new SphereGeometry(RADIUS, 48, 32), new MeshStandardMaterial({ color, metalness, roughness }));
}

/** Returns small spheres at `probes`. */
function spheresAt(volume, probes, material) {
  const size = PROBE_SHARE * volume.source.grid.spacing;
  const spheres = new InstancedMesh(new IcosahedronGeometry(size, 2), material, probes.length);
  probes.forEach((probe, i) => spheres.setMatrixAt(i, new Matrix4().setPosition(volume.positionOfProbe(probe))));
  return spheres;
}

export class Moving {
  constructor(scene) {
    this.group = new Group();
    this.parts = { figure: new Group(), spheres: new Group().add(ball(0xffffff, 1, 0), ball(0xcccccc, 0, 1)), probes: new Group() };
    this.shown = { figure: false, spheres: false, probes: false };
    this.parts.spheres.children.forEach((sphere, i) => sphere.position.set(i === 0 ? ASIDE : -ASIDE, HIGH, 0));
    this.group.add(...Object.values(this.parts));
    scene.add(this.group);
    this.model = null; // PrtkitModel
    this.volume = null;
    this.walk = null;
    this.occluders = null; // occluders of the figure
    this.mixer = null; // mixer of the figure, after it is loaded
    this.speed = USUAL_SPEED;
    this.metres = 0;
    this.placeAll();
  }

  /** Loads a figure that can walk: the animation "walk", or the first. */
  async load(url, progress) {
    const loader = new GLTFLoader().register((parser) => new PrtkitPlugin(parser));
    const { scene, animations, userData } = await loader.loadAsync(url, progress);
    this.occluders = userData.prtkitOccluders ?? null;
    const clip = animations.find(({ name }) => /walk/i.test(name)) ?? animations[0];
    this.parts.figure.add(scene);
    if (clip) {
      this.mixer = new AnimationMixer(scene);
      this.mixer.clipAction(clip).play();
      this.speed = clip.userData?.speed ?? USUAL_SPEED;
    }
    if (this.volume) this.volume.light(scene);
    this.passBy();
    this.placeAll();
  }

  /** Makes the figure occlude baked surfaces, if it has occluders. */
  passBy() {
    if (this.model?.setOccluders && this.walk) this.model.setOccluders(this.occluders);
  }

  /** Continues in a different scene: `gltf`, and the path of Walk there. Without a volume nothing is shown. */
  enter(gltf, way) {
    this.model = gltf.userData.prtkit;
    this.volume = this.model.volume ?? null;
    this.walk = this.volume ? new Walk(gltf.scene, way) : null;
    this.metres = 0;
    this.removeProbes();
    if (this.volume) this.volume.light(this.group);
    this.passBy();
    this.placeAll();
  }

  removeProbes() {
    for (const spheres of this.parts.probes.children) {
      spheres.geometry.dispose();
      spheres.material.dispose();
      spheres.dispose();
    }
    this.parts.probes.clear();
  }

  /** Creates the probes, each lit by its surroundings; probes inside geometry are red. */
  makeProbes() {
    const { volume } = this;
    const all = Array.from({ length: volume.probes }, (_, probe) => probe);
    const open = spheresAt(volume, all.filter((probe) => !volume.isSealed(probe)), new MeshStandardMaterial({ roughness: 1 }));
    const sealed = spheresAt(volume, all.filter((probe) => volume.isSealed(probe)), new MeshBasicMaterial({ color: 0xff0000, toneMapped: false }));
    volume.light(open);
    open.castShadow = open.receiveShadow = false;
    this.parts.probes.add(open, sealed);
  }

  /** `part`: "figure", "spheres" or "probes". */
  show(part, shown) {
    this.shown[part] = shown;
    this.placeAll();
  }

  /** True if the picture changes from frame to frame. */
  get isWalking() {
    return this.walk !== null && ((this.shown.figure && this.mixer !== null) || this.shown.spheres);
  }

  /** True if the light of the volume is not complete yet; invisible objects do not count. */
  get isWaiting() {
    return Object.values(this.parts).some(({ visible, children }) => visible && children.length > 0) && !this.volume.isSettled;
  }

  advance(seconds) {
    this.metres += this.speed * seconds;
    this.mixer?.update(seconds);
    this.placeAll();
  }

  placeAll() {
    const { figure, spheres, probes } = this.parts;
    for (const [name, part] of Object.entries(this.parts)) part.visible = this.walk !== null && this.shown[name];
    if (probes.visible && probes.children.length === 0) this.makeProbes();
    if (!this.walk) return;
    figure.position.copy(this.walk.at(this.metres));
    figure.rotation.y = this.walk.heading(this.metres);
    spheres.position.copy(figure.position);
    spheres.rotation.copy(figure.rotation);
  }
}
