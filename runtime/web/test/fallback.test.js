// Loads files with baked fallback light through GLTFLoader: with the plug-in the fallback is ignored, without
// it the model is unlit.
import assert from "node:assert/strict";
import { test } from "node:test";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { PrtkitPlugin } from "../src/PrtkitLoader.js";
import { bakedModel } from "./bakedModel.js";
import { setIn } from "./transferSets.js";

globalThis.ProgressEvent ??= Event; // exists in browsers; three's FileLoader creates some
const count = (json, { attributes }) => json.accessors?.[attributes.POSITION].count;

/** Adds a fallback: colors for the floor, none for the ball, and no fallback for the emissive lantern. */
function addFallback(json, binary) {
  delete json.textures;
  json.materials = json.materials.map(({ normalTexture: _, ...material }) => structuredClone(material));
  setIn(json, "vertices").fallback = { exposure: 0.5 };
  const counts = json.meshes.map(({ primitives }) => count({ accessors: binary.accessors }, primitives[0]));
  const colors = (i, value) => binary.accessor(new Float32Array(3 * counts[i]).fill(value), "VEC3");
  for (const i of [0, 1]) {
    json.materials[i].extensions = { KHR_materials_unlit: { extras: { prtkit: "fallback" } } };
    json.meshes[i].primitives[0].attributes.COLOR_0 = colors(i, 0.25);
  }
  json.meshes[0].primitives[0].attributes._PRT_COLOR_0 = colors(0, 0.75);
  json.meshes[2].primitives[0].attributes.COLOR_0 = colors(2, 1);
}

function load(plugged) {
  const file = bakedModel("vertices", addFallback);
  const loader = new GLTFLoader();
  if (plugged) loader.register((parser) => new PrtkitPlugin(parser));
  return loader.parseAsync(file.buffer.slice(file.byteOffset, file.byteOffset + file.length), "");
}

test("the plug-in ignores the fallback", async () => {
  const { scene, userData } = await load(true);
  const [floor, ball, lantern] = scene.children;
  for (const { material } of [floor, ball, lantern]) assert.ok(material.isMeshStandardMaterial && material.defines.PRT_PACKED_WORDS);
  assert.deepEqual([floor, ball, lantern].map(({ material }) => material.vertexColors), [true, false, true]);
  assert.equal(floor.geometry.getAttribute("color").getX(0), 0.75);
  assert.equal(lantern.geometry.getAttribute("color").getX(0), 1);
  for (const { geometry } of scene.children) assert.equal(geometry.getAttribute("_prt_color_0"), undefined);
  assert.ok(userData.prtkit.vertices > 0);
});

test("without the plug-in the fallback is shown", async () => {
  const { scene } = await load(false);
  const [floor, ball, lantern] = scene.children;
  for (const { material, geometry } of [floor, ball]) {
    assert.ok(material.isMeshBasicMaterial && material.vertexColors);
    assert.equal(geometry.getAttribute("color").getX(0), 0.25);
  }
  assert.ok(lantern.material.isMeshStandardMaterial);
});
