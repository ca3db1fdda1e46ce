// The suns of a light file as three's directional lights, with shadow maps fitted to the lit objects.

import { Box3, DirectionalLight, Group, Vector3 } from "three";
import { environmentRotation, shownBy, rotatedBy } from "./rotations.js";

const RADIUS_AT = 0.1; // equal to the value in sunLight.glsl
const MARGIN = 2; // texels of a map beyond the fitted box

/**
 * Returns the light of one sun: irradiance is the factor that three multiplies with base color / pi and the
 * cosine.
 */
function lightOf({ irradiance }, mapSize) {
  const strongest = Math.max(...irradiance);
  const light = new DirectionalLight(0xffffff, strongest);
  if (strongest > 0) light.color.setRGB(...irradiance.map((value) => value / strongest));
  light.castShadow = true;
  light.shadow.mapSize.set(mapSize, mapSize);
  return light;
}

/**
 * Add it directly to the scene. It lights other materials of the scene like any light.
 */
export class SunLights extends Group {
  /** `suns`: see readLightFile. `mapSize`: texels along each side of a shadow map. */
  constructor(suns, { mapSize = 2048 } = {}) {
    super();
    this.suns = suns;
    this.rotated = [1, 0, 0, 0, 1, 0, 0, 0, 1];
    this.scene = null; // see follow
    this.shown = "";
    this.box = new Box3(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));
    this.lights = suns.map((sun) => lightOf(sun, mapSize));
    for (const light of this.lights) this.add(light, light.target);
    this.updateTransform();
  }

  /**
   * Fits the shadow maps to `object`, an Object3D or a Box3: objects outside neither cast nor receive
   * shadows.
   */
  fit(object) {
    const box = object.isBox3 ? object.clone() : new Box3().setFromObject(object);
    if (box.isEmpty()) throw new RangeError("shadow maps cannot be fitted to an empty box");
    this.box = box;
    this.updateTransform();
    return this;
  }

  /** Rotates the suns about +Y by `angle` radians, as `setLight` does with the light. */
  rotate(angle) {
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    this.scene = null;
    this.rotated = [c, 0, -s, 0, 1, 0, s, 0, c];
    this.updateTransform();
    return this;
  }

  /**
   * Rotates and dims the suns, in every frame, as `scene` does its environment, as `setSky` does with the
   * light.
   */
  follow(scene) {
    this.scene = scene;
    this.shown = "";
    this.followScene();
    return this;
  }

  followScene() {
    const { euler, strength } = shownBy(this.scene);
    const now = [euler.x, euler.y, euler.z, euler.order, strength].join();
    if (now === this.shown) return;
    this.shown = now;
    this.rotated = environmentRotation(euler);
    this.dim(strength);
    this.updateTransform();
  }

  /** Three calls this before it draws shadow maps. */
  updateMatrixWorld(force) {
    if (this.scene) this.followScene();
    super.updateMatrixWorld(force);
  }

  /** Multiplies the original strength of the suns by a factor. */
  dim(factor) {
    this.lights.forEach((light, i) => (light.intensity = factor * Math.max(...this.suns[i].irradiance)));
    return this;
  }

  updateTransform() {
    const centre = this.box.getCenter(new Vector3());
    const radius = Math.max(this.box.getSize(new Vector3()).length() / 2, 1e-6);
    this.lights.forEach((light, i) => {
      const { towards, halfAngle } = this.suns[i];
      light.target.position.copy(centre);
      light.position.fromArray(rotatedBy(this.rotated, towards));
      light.position.multiplyScalar(2 * radius).add(centre);
      fitShadow(light.shadow, light.position, this.box, Math.tan(Math.min(halfAngle, 1.5)));
    });
  }

  dispose() {
    for (const light of this.lights) light.dispose();
  }
}

/**
 * Fits the camera of a shadow map, at `from` and facing the middle of `box`, so that it sees exactly the box.
 */
function fitShadow(shadow, from, box, tangent) {
  const { camera, mapSize } = shadow;
  camera.position.copy(from);
  camera.lookAt(box.getCenter(new Vector3())); // three's shadow uses this orientation
  camera.updateMatrixWorld(true);
  const low = new Vector3(Infinity, Infinity, Infinity);
  const high = low.clone().negate();
  for (let corner = 0; corner < 8; ++corner) {
    const pick = (axis, bit) => (corner & bit ? box.max[axis] : box.min[axis]);
    const at = new Vector3(pick("x", 1), pick("y", 2), pick("z", 4)).applyMatrix4(camera.matrixWorldInverse);
    low.min(at);
    high.max(at);
  }
  // The center of the box is centered. Square, because three's filters use one radius for both axes.
  const half = Math.max(high.x, high.y, 1e-6) / (1 - (2 * MARGIN) / mapSize.x);
  Object.assign(camera, { left: -half, right: half, bottom: -half, top: half });
  const slack = 1e-3 * (high.z - low.z) + 1e-6;
  camera.near = -high.z - slack;
  camera.far = -low.z + slack;
  camera.updateProjectionMatrix();

  const texel = (2 * half) / mapSize.x;
  shadow.radius = (tangent * RADIUS_AT * (camera.far - camera.near)) / texel;
  // Bias for three's filters, which compare their taps with one depth. A tap at a distance of r texels of size t,
  // along a slope of angle a to the light, is r t tan(a) deeper; an offset d along the normal compensates
  // this if d >= r t sin(a); taps are in a square.
  shadow.normalBias = Math.SQRT2 * (shadow.radius + 1) * texel;
  shadow.needsUpdate = true;
}
