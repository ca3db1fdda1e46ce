// Materials of nodes, without a device. renderers.mjs draws them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { PrtkitPlugin } from "../src/webgpu.js";
import { bakedModel } from "./bakedModel.js";

async function load(by) {
  const file = bakedModel(by, (json) => {
    delete json.textures; // node does not decode images
    json.materials = json.materials.map(({ normalTexture: _, ...material }) => material);
  });
  const loader = new GLTFLoader().register((parser) => new PrtkitPlugin(parser));
  return loader.parseAsync(file.buffer.slice(file.byteOffset, file.byteOffset + file.length), "");
}

test("node materials and their clones keep the properties that three uses", async () => {
  const { scene, userData } = await load("vertices");
  const [floor, ball, lantern] = scene.children.map(({ material }) => material);
  assert.ok([floor, ball, lantern].every(({ isNodeMaterial }) => isNodeMaterial));
  assert.equal(lantern.clearcoat, 0.8);
  assert.equal(ball.metalness, 0.6);
  const clone = ball.clone();
  clone.color.set(0x00ff00);
  assert.notDeepEqual(ball.color, clone.color);
  assert.equal(clone.roughness, ball.roughness);
  assert.equal(clone.customProgramCacheKey(), ball.customProgramCacheKey());
  assert.equal(userData.prtkit.vertices, 25 * 25 + 41 * 25 + 25 * 17);
});

test("different models have different programs", async () => {
  const [a, b] = await Promise.all([load("vertices"), load("vertices")]);
  const key = ({ scene }) => scene.children[0].material.customProgramCacheKey();
  assert.notEqual(key(a), key(b));
});

test("more weights than WebGPU supports are rejected", async () => {
  const { scene } = await load("weights");
  const { material } = scene.children[0];
  material._transfer.defines.PRT_WEIGHT_VECTORS = 6;
  const builder = { renderer: { backend: { isWebGPUBackend: true } } };
  assert.throws(() => material.setupLightingModel(builder), /this many weights per vertex.*fewer --components/);
});
