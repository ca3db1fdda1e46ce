// Tests the lights that represent suns in three.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Box3, BoxGeometry, Matrix4, Mesh, Scene, Vector3 } from "three";
import { SunLights } from "../src/SunLights.js";

const near = (actual, expected, tolerance, what = "") =>
  assert.ok(Math.abs(actual - expected) <= tolerance, `${what} ${actual} is not within ${tolerance} of ${expected}`);

const sun = { towards: [0.48, 0.6, -0.64], irradiance: [3, 2, 1], halfAngle: 0.0046 };
const direction = (light) => light.position.clone().sub(light.target.position).normalize();

test("a sun is a directional light with its irradiance and rotates with the light", () => {
  const lights = new SunLights([{ ...sun, towards: [0, 0, 1] }]);
  const [light] = lights.lights;
  assert.ok(light.isDirectionalLight && light.castShadow);
  assert.deepEqual(light.color.clone().multiplyScalar(light.intensity).toArray().map((v) => Math.round(1e6 * v) / 1e6), [3, 2, 1]);
  near(direction(light).z, 1, 1e-12);
  lights.rotate(Math.PI / 2);
  near(direction(light).x, 1, 1e-12); // after a quarter rotation, light from +Z comes from +X
  assert.equal(lights.dim(0.5).dim(0.25).lights[0].intensity, 0.75);
  assert.equal(new SunLights([{ ...sun, irradiance: [0, 0, 0] }]).lights[0].intensity, 0);
});

test("a shadow map contains its box from every direction and is filled by it", () => {
  const box = new Box3(new Vector3(-4, 0, -10), new Vector3(4, 4, 1));
  for (const towards of [sun.towards, [0, 1, 0], [0, -1, 0], [1, 0, 0], [-0.6, 0.8, 0]])
    for (const angle of [0, 0.7, 3]) {
      const lights = new SunLights([{ ...sun, towards }]).fit(box).rotate(angle);
      lights.updateMatrixWorld(true);
      const [light] = lights.lights;
      light.shadow.updateMatrices(light); // three's renderer does this
      const seen = new Box3();
      for (let corner = 0; corner < 8; ++corner) {
        const at = new Vector3(corner & 1 ? 4 : -4, corner & 2 ? 4 : 0, corner & 4 ? 1 : -10);
        seen.expandByPoint(at.applyMatrix4(light.shadow.matrix));
      }
      for (const axis of ["x", "y", "z"]) {
        assert.ok(seen.min[axis] >= 0 && seen.max[axis] <= 1, `${towards}, ${angle}: ${axis} ${seen.min[axis]} ${seen.max[axis]}`);
        near(seen.min[axis] + seen.max[axis], 1, 1e-3);
      }
      near(seen.max.z - seen.min.z, 1, 0.01);
      near(Math.max(seen.max.x - seen.min.x, seen.max.y - seen.min.y), 1, 0.01);
    }
});

test("the shadow radius is the sun's at a tenth of the depth", () => {
  const box = new Box3(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));
  const [{ shadow }] = new SunLights([{ ...sun, towards: [0, 1, 0], halfAngle: 0.02 }], { mapSize: 1000 }).fit(box).lights;
  const texel = (shadow.camera.right - shadow.camera.left) / 1000;
  near(shadow.radius * texel, Math.tan(0.02) * 0.2, 1e-4);
  assert.equal(shadow.mapSize.x, 1000);
  assert.equal(new SunLights([{ ...sun, halfAngle: 0 }]).lights[0].shadow.radius, 0);
});

test("shadow maps fit objects at any position; an empty object is rejected", () => {
  const mesh = new Mesh(new BoxGeometry(2, 2, 2));
  mesh.position.set(100, 0, 0);
  const lights = new SunLights([sun]).fit(new Scene().add(mesh));
  near(lights.lights[0].target.position.x, 100, 1e-9);
  assert.throws(() => lights.fit(new Scene()), RangeError);
  const point = new Box3(new Vector3(1, 1, 1), new Vector3(1, 1, 1));
  const { camera, radius, normalBias } = lights.fit(point).lights[0].shadow;
  for (const value of [...camera.projectionMatrix.elements, radius, normalBias]) assert.ok(Number.isFinite(value));
  assert.ok(camera.projectionMatrix.determinant() !== 0);
  assert.notDeepEqual(camera.projectionMatrix, new Matrix4());
});
