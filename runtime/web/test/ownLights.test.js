// Directional lights of a user's own scene as suns, and warnings of lights that do not light baked meshes.
import assert from "node:assert/strict";
import { test } from "node:test";
import { AmbientLight, DirectionalLight, Group, PointLight, Scene } from "three";
import { LitTransfer } from "../src/LitTransfer.js";
import { PrtkitPlugin } from "../src/PrtkitLoader.js";
import { evaluateSh, ShLight } from "../src/sphericalHarmonics.js";
import { noteLightsOfFile } from "../src/unusedLights.js";
import { transferOf } from "./transferSets.js";

const ORDER = 3;

class Recorded extends LitTransfer {
  constructor(root = new Group()) {
    super({ order: ORDER, terms: [{ kind: "direct", channels: 3 }] }, root);
  }

  update(sky, suns) {
    this.computed = { sky, suns };
  }
}

const dark = ShLight.fromCoefficients(ORDER, new Float64Array(3 * ORDER ** 2));

function sunIn(scene) {
  const sun = new DirectionalLight(0xffffff, 3);
  sun.color.setRGB(1, 0.5, 0.25);
  sun.position.set(1, 2, 4);
  sun.target.position.set(-1, 0, 3); // direction (2, 2, 1) / 3
  scene.add(sun, sun.target);
  return sun;
}

/** A point light's coefficients are irradiance times the basis in its direction. */
function near(computed, direction, irradiance) {
  evaluateSh(ORDER, ...direction).forEach((value, i) =>
    irradiance.forEach((e, c) => assert.ok(Math.abs(computed[3 * i + c] - e * value) < 1e-9, `coefficient ${i}, channel ${c}`)));
}

test("a DirectionalLight is a sun from its own direction for every rotation of the sky", () => {
  const scene = new Scene();
  const sun = sunIn(scene);
  scene.backgroundRotation.set(0.3, 1, 0);
  scene.backgroundIntensity = 0.5;
  const model = new Recorded();
  model.setSky(dark, scene, { suns: [sun] });
  near(model.computed.suns, [2 / 3, 2 / 3, 1 / 3], [3, 1.5, 0.75]);
});

test("a model follows direction, strength and visibility of a DirectionalLight, and its own rotation", () => {
  const scene = new Scene();
  const sun = sunIn(scene);
  const root = new Group();
  const model = new Recorded(root);
  model.setSky(dark, scene, { suns: [sun] });
  sun.position.set(-1, 0, 8);
  sun.intensity = 1;
  model.followSky();
  near(model.computed.suns, [0, 0, 1], [1, 0.5, 0.25]);
  root.rotation.y = Math.PI / 2; // +X of the model now faces -Z
  root.updateMatrixWorld(true);
  model.followSky();
  near(model.computed.suns, [-1, 0, 0], [1, 0.5, 0.25]);
  sun.visible = false;
  model.followSky();
  assert.ok(model.computed.suns.every((value) => value === 0));
  sun.visible = true;
  scene.remove(sun);
  model.followSky();
  assert.ok(model.computed.suns.every((value) => value === 0), "three does not use it");
});

test("suns other than DirectionalLights are rejected with a reason", () => {
  const scene = new Scene();
  const model = new Recorded();
  for (const wrong of [new PointLight(), {}, null, "sun"])
    assert.throws(() => model.setSky(dark, scene, { suns: [wrong] }), /suns must be an array of DirectionalLights/);
  assert.throws(() => model.setLight(dark, 0, [sunIn(scene)]), /only setSky takes an array of lights/);
});

/** Returns the warnings during `work`. */
function warningsOf(work) {
  const { warn } = console;
  const found = [];
  console.warn = (text) => found.push(text);
  try {
    work();
  } finally {
    console.warn = warn;
  }
  return found;
}

test("each light that does not light baked meshes is reported once", () => {
  const scene = new Scene();
  const sun = Object.assign(sunIn(scene), { name: "Sun" });
  const file = new Group().add(Object.assign(new PointLight(), { name: "Lantern" }));
  noteLightsOfFile(file);
  scene.add(file, Object.assign(new AmbientLight(), { name: "Around" }), Object.assign(new PointLight(0xffffff, 0), { name: "Off" }));
  const hidden = Object.assign(new PointLight(), { name: "Hidden", visible: false });
  scene.add(hidden);
  const model = new Recorded();
  const drawn = () => warningsOf(() => model.checkLights(scene));
  assert.deepEqual(drawn(), []); // before it has any light
  model.setSky(dark, scene);
  const found = drawn();
  assert.equal(found.length, 2);
  assert.match(found.join("\n"), /DirectionalLight "Sun" does not light baked meshes: pass it in setSky\(light, scene, \{ suns/);
  assert.match(found.join("\n"), /AmbientLight "Around" does not light baked meshes/);
  model.setSky(dark, scene);
  assert.deepEqual(drawn(), []);
  const other = Object.assign(sunIn(scene), { name: "Other" });
  model.setSky(dark, scene, { suns: [sun] });
  assert.match(drawn().join(), /^[^,]*"Other" lights baked meshes without bounces/);
  const third = sunIn(scene);
  model.setSky(dark, scene, { suns: [sun, other, third] });
  assert.deepEqual(drawn(), []);
  model.setLight(dark, 0, dark); // suns of SunLights
  assert.deepEqual(drawn(), []);
});

const SET = { receivers: "vertices", coding: "clustered", order: 1, terms: [{ kind: "combined", channels: 1 }], components: [0], bases: { bufferView: 0 } };

for (const [what, json] of Object.entries({
  "nodes that are not a list": { nodes: { a: 1 }, extensions: {} },
  "no scene, but occluders": { nodes: [{ extensions: { PRTKIT_occlusion_volume: {} } }], extensions: {} },
  "no scene, but transfer": { nodes: [], extensions: transferOf(SET) },
}))
  test(`${what}: an Error with a reason`, async () => {
    const parser = { json, associations: new Map() };
    await assert.rejects(new PrtkitPlugin(parser).afterRoot({ scenes: [], scene: undefined, userData: {} }), (error) => {
      assert.ok(error.constructor === Error && /^PRTKIT_\w+: (nodes is not a list|the file has no scene)$/.test(error.message), `${error}`);
      return true;
    });
  });

test("nodes of shared instances that are not a list: an Error with a reason", async () => {
  const json = { nodes: 3, extensions: { ...transferOf(SET), PRTKIT_instances: { version: 1, count: 1, boxes: [{ middle: [0, 0, 0], half: [1, 1, 1] }], factors: { bufferView: 0 } } } };
  const plugin = new PrtkitPlugin({ json });
  await assert.rejects(plugin.beforeRoot(), (error) => error.constructor === Error && /^PRTKIT_instances: /.test(error.message));
});

test("a file without a scene and without transfer loads as usual", async () => {
  const gltf = { scenes: [], scene: undefined, userData: {} };
  await new PrtkitPlugin({ json: { asset: {} }, associations: new Map() }).afterRoot(gltf);
  assert.deepEqual(gltf.userData, {});
});
