// Tests automatic rotation and dimming of the light, and the sources of light.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  Color,
  DataTexture,
  DataUtils,
  Euler,
  FloatType,
  HalfFloatType,
  LightProbe,
  Object3D,
  Quaternion,
  RGBAFormat,
  Scene,
  ShaderChunk,
  SphericalHarmonics3,
  Texture,
  Vector3,
} from "three";
import { lightFromProbe, PrtkitModel, projectEquirectangular, projectInWorker, SunLights } from "../src/PrtkitLoader.js";
import { halfFloat } from "../src/halfFloat.js";
import { evaluateSh, ShLight } from "../src/sphericalHarmonics.js";
import { environmentRotation, rotatedBy } from "../src/rotations.js";
import { decodedSet } from "./transferSets.js";

const near = (actual, expected, tolerance, what = "") =>
  assert.ok(Math.abs(actual - expected) <= tolerance, `${what} ${actual} is not within ${tolerance} of ${expected}`);
const allNear = (actual, expected, tolerance, what) => expected.forEach((value, i) => near(actual[i], value, tolerance, `${what}, ${i}:`));

/**
 * Returns a model of one cluster without components; its mean is that of an unoccluded receiver facing +X in
 * a light of order 2.
 */
function modelTowardsX(root) {
  const values = [0.25, 0, 0, -0.3];
  const set = { receivers: "vertices", coding: "clustered", order: 2, terms: [{ kind: "combined", channels: 1 }], components: [0], bases: { bufferView: 0 } };
  return new PrtkitModel(decodedSet(set, () => new Uint8Array(new Float32Array(values).buffer)), root);
}

const redOf = (model) => model.constantsTexture.image.data[0];
/** Red value under white light from one direction d: 0.25 Y_0 + 0.3 * 0.4886 x. */
const expectedRed = (x) => 0.25 * 0.282094791774 + 0.3 * 0.488602511903 * x;

/** Light from one direction, in all three channels. */
function lightFrom(d, order = 2) {
  const basis = evaluateSh(order, ...d);
  return ShLight.fromCoefficients(order, Float64Array.from({ length: 3 * order * order }, (_, i) => basis[Math.floor(i / 3)]));
}

test("a rotation of the environment about +Y equals the angle of setLight, in all releases of three", () => {
  for (const revision of [180, 187]) {
    const rotated = rotatedBy(environmentRotation(new Euler(0, Math.PI / 2, 0), revision), [0, 0, 1]);
    allNear(rotated, [1, 0, 0], 1e-12, revision);
  }
});

test("three looks up environments as expected", () => {
  // The lookup is a matrix times the direction; the matrix has changed with release 184, which e2e.mjs tests.
  assert.match(ShaderChunk.envmap_physical_pars_fragment, /envMapRotation \* worldNormal/);
  const euler = new Euler(0.4, -0.7, 1.1);
  const d = [0.36, 0.48, 0.8];
  const later = rotatedBy(environmentRotation(euler, 187), d);
  allNear(new Vector3(...d).applyEuler(euler).toArray(), later, 1e-12, "release 187");
  const lookup = new Vector3(...rotatedBy(environmentRotation(euler, 180), d)).applyEuler(new Euler(-0.4, 0.7, -1.1));
  allNear(lookup.toArray(), d, 1e-12, "release 180");
});

test("a sky follows rotation and intensity of its scene", () => {
  const root = new Object3D();
  const model = modelTowardsX(root);
  const scene = new Scene();
  model.setSky(lightFrom([0, 0, 1]), scene);
  near(redOf(model), expectedRed(0), 1e-6);
  scene.backgroundRotation.y = Math.PI / 2;
  model.beforeRender();
  near(redOf(model), expectedRed(1), 1e-6, "rotated");
  scene.environment = new Texture(); // it has a separate rotation
  model.beforeRender();
  near(redOf(model), expectedRed(0), 1e-6, "environment");
  scene.environmentRotation.y = -Math.PI / 2;
  scene.environmentIntensity = 3;
  model.beforeRender();
  near(redOf(model), 3 * expectedRed(-1), 1e-6, "dimmed");
  const { version } = model.constantsTexture;
  model.beforeRender();
  assert.equal(model.constantsTexture.version, version, "light is not computed again without a change");
  model.setLight(lightFrom([1, 0, 0])); // ends it
  scene.environmentRotation.y = 1;
  model.beforeRender();
  near(redOf(model), expectedRed(1), 1e-6, "by hand");
});

test("a rotated model sees the sky rotated back", () => {
  const root = new Object3D();
  const model = modelTowardsX(root);
  model.setSky(lightFrom([0, 1, 0]), new Scene());
  near(redOf(model), expectedRed(0), 1e-6);
  root.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(1, 0, 0), new Vector3(0, 1, 0)));
  root.scale.set(2, 5, 3);
  root.position.set(7, 8, 9);
  root.updateMatrixWorld();
  model.beforeRender();
  near(redOf(model), expectedRed(1), 1e-6);
});

test("suns follow the scene like the light", () => {
  const scene = new Scene();
  scene.environment = new Texture();
  const towards = [0.48, 0.6, -0.64];
  const suns = new SunLights([{ towards, irradiance: [3, 2, 1], halfAngle: 0 }]).follow(scene);
  scene.add(suns);
  scene.environmentRotation.set(0.3, 1, -0.5);
  scene.environmentIntensity = 0.5;
  scene.updateMatrixWorld();
  const [light] = suns.lights;
  const direction = light.position.clone().sub(light.target.position).normalize().toArray();
  allNear(direction, rotatedBy(environmentRotation(scene.environmentRotation), towards), 1e-9, "direction");
  near(light.intensity, 1.5, 1e-12);
});

test("a light probe lights with the radiance that three evaluates", () => {
  const probe = new LightProbe(new SphericalHarmonics3(), 2);
  probe.sh.coefficients.forEach((c, i) => c.set(Math.sin(i + 1), Math.cos(i), 0.1 * i));
  const light = lightFromProbe(probe);
  assert.equal(light.order, 10);
  const coefficients = light.coefficients();
  for (const d of [[0.36, -0.48, 0.8], [-0.6, 0.8, 0], [0, 0, -1]]) {
    const radiance = probe.sh.getAt(new Vector3(...d), new Vector3()).toArray(); // three's own evaluation
    const basis = evaluateSh(10, ...d);
    for (let c = 0; c < 3; ++c)
      near(basis.reduce((sum, y, i) => sum + y * coefficients[3 * i + c], 0), 2 * radiance[c], 1e-5, `${d}`);
  }
});

test("a probe of one colour is a sky of that colour", () => {
  const probe = new LightProbe();
  probe.sh.coefficients[0].set(1, 2, 3).multiplyScalar(Math.sqrt(4 * Math.PI)); // radiance 1, 2, 3
  const light = lightFromProbe(probe, 1);
  near(light.meanLuminance(), new Color(1, 2, 3).toArray().reduce((sum, v, c) => sum + v * [0.2126, 0.7152, 0.0722][c], 0), 1e-9);
});

test("half floats of a worker equal those of three", () => {
  for (let bits = 0; bits < 65536; bits += 7)
    if (((bits >> 10) & 31) !== 31) assert.equal(halfFloat(bits), DataUtils.fromHalfFloat(bits), `${bits}`);
  assert.equal(halfFloat(0xfc00), -Infinity);
  assert.ok(Number.isNaN(halfFloat(0x7e00)));
});

/** Provides a Worker that runs src/projectionWorker.js in this thread, with copied messages as in a browser. */
async function withWorker(body) {
  await import("../src/projectionWorker.js");
  const { onmessage } = globalThis;
  const seen = [];
  globalThis.Worker = class {
    constructor(url, options) {
      seen.push(url.pathname, options.type);
    }
    postMessage(message) {
      globalThis.postMessage = (answer) => this.onmessage({ data: structuredClone(answer) });
      onmessage({ data: structuredClone(message) });
    }
    terminate() {
      seen.push("terminated");
    }
  };
  try {
    await body(seen);
  } finally {
    delete globalThis.Worker;
    delete globalThis.postMessage;
    delete globalThis.onmessage;
  }
}

test("a worker, if available, projects like the caller", async () => {
  const values = [1, 2, 3, 1, 5, 4, 3, 1];
  const textures = [
    new DataTexture(new Float32Array(values), 2, 1, RGBAFormat, FloatType),
    new DataTexture(new Uint16Array(values.map(DataUtils.toHalfFloat)), 2, 1, RGBAFormat, HalfFloatType),
  ];
  const expected = projectEquirectangular(textures[0], 3, { center: "z" }).polar;
  allNear((await projectInWorker(textures[0], 3, { center: "z" })).polar, [...expected], 1e-12, "without");
  await withWorker(async (seen) => {
    for (const texture of textures)
      allNear((await projectInWorker(texture, 3, { center: "z" })).polar, [...expected], 1e-12, "with");
    assert.ok(seen[0].endsWith("/projectionWorker.js"));
    assert.deepEqual(seen.slice(1, 3), ["module", "terminated"]);
    await assert.rejects(projectInWorker(textures[0], 11), RangeError);
  });
});
