// Tests files with PRTKIT_lightmap: loading and rejection. renderers.mjs draws them.
import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import { ShaderLib } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { PrtkitPlugin, ShLight } from "../src/PrtkitLoader.js";
import { bakedModel, MAPS } from "./bakedModel.js";
import { png } from "./glb.js";

const { createImageBitmap } = globalThis;
globalThis.ProgressEvent ??= Event; // exists in browsers; three's FileLoader creates some
let asked;
beforeEach(() => {
  asked = [];
  globalThis.createImageBitmap = async (blob, options) => (asked.push(options), { blob });
});
afterEach(() => (globalThis.createImageBitmap = createImageBitmap));

/** The file, without textures for which node has no decoder. */
function load(change = () => {}) {
  const file = bakedModel("texels", (json, binary) => {
    delete json.textures;
    json.materials = json.materials.map(({ normalTexture: _, ...material }) => material);
    change(json, binary);
  });
  const loader = new GLTFLoader().register((parser) => new PrtkitPlugin(parser));
  return loader.parseAsync(file.buffer.slice(file.byteOffset, file.byteOffset + file.length), "");
}
const extensionOf = (json) => json.extensions.PRTKIT_lightmap;

test("materials have a rendered light map with the texture coordinates of the file", async () => {
  const { scene, userData } = await load();
  const { prtkit } = userData;
  assert.equal(prtkit.texels, MAPS[0].width * MAPS[0].height + MAPS[1].width * MAPS[1].height);
  assert.equal(prtkit.bytesPerTexel, 8);
  assert.deepEqual([prtkit.vertices, prtkit.lamps, prtkit.hasDirectTerm], [0, ["Lantern"], true]);
  const materials = scene.children.map(({ material }) => material);
  assert.deepEqual(materials.map(({ lightMap }) => lightMap.channel), [1, 1, 0]);
  assert.equal(new Set(materials.map(({ lightMap }) => lightMap)).size, 3);
  for (const material of materials) {
    assert.equal(material.lightMapIntensity, Math.PI);
    assert.equal(material.clone().lightMap, material.lightMap);
    assert.equal(material.lightMap.flipY, false);
    const shader = { uniforms: {}, vertexShader: ShaderLib.physical.vertexShader, fragmentShader: ShaderLib.physical.fragmentShader };
    material.onBeforeCompile(shader);
    assert.match(shader.fragmentShader, /#ifdef PRT_LIGHTMAP\s+vec3 prtRadiance = RECIPROCAL_PI \* irradiance;/);
  }
});

test("images of words are decoded without conversion", async () => {
  const { userData } = await load();
  assert.equal(asked.length, 4);
  for (const options of asked)
    assert.deepEqual(options, { premultiplyAlpha: "none", colorSpaceConversion: "none", imageOrientation: "none" });
  for (const { words } of userData.prtkit.maps.maps)
    for (const texture of words) assert.ok(!texture.flipY && !texture.generateMipmaps && !texture.premultiplyAlpha);
});

test("separate image files are read", async () => {
  const { userData } = await load((json, binary) => {
    const bytes = binary.chunks[2 * json.images[1].bufferView];
    json.images[1] = { uri: `data:image/png;base64,${bytes.toString("base64")}` };
  });
  assert.equal(userData.prtkit.maps.maps[0].words.length, 2);
});

test("maps are drawn again for each renderer after a change of light", async () => {
  const { userData } = await load();
  const { prtkit } = userData;
  const drawn = [];
  prtkit.maps.pass.draw = (renderer, target, { width }) => drawn.push([renderer.name, width]);
  const [a, b] = [{ name: "a" }, { name: "b" }];
  const light = ShLight.fromCoefficients(2, new Array(12).fill(1));
  prtkit.setLight(light);
  prtkit.beforeRender(a);
  prtkit.beforeRender(a);
  assert.deepEqual(drawn.splice(0), [["a", 96], ["a", 40], ["a", 96]]); // the last by other coordinates
  prtkit.beforeRender(b);
  assert.equal(drawn.splice(0).length, 3);
  prtkit.setLight(light, 1);
  prtkit.beforeRender(a);
  assert.equal(drawn.splice(0).length, 3);
  prtkit.dispose();
  prtkit.beforeRender(a);
  assert.equal(drawn.length, 3);
});

test("maps are drawn again after a lost device is restored", async () => {
  const { userData } = await load();
  const { prtkit } = userData;
  let drawn = 0;
  prtkit.maps.pass.draw = () => ++drawn;
  const renderer = { domElement: new EventTarget() };
  for (let i = 0; i < 2; ++i) prtkit.beforeRender(renderer);
  assert.equal(drawn, 3);
  renderer.domElement.dispatchEvent(new Event("webglcontextrestored"));
  prtkit.beforeRender(renderer);
  assert.equal(drawn, 6);
});

const refusals = {
  "another version": [(json) => (extensionOf(json).version = 1), /version 1 is not supported, only 2; compress the model again/],
  "a raw bake": [(json) => (extensionOf(json).raw = {}), /the file is an uncompressed bake; compress it: prt compress/],
  "predictors": [(json) => Object.assign(extensionOf(json), { predictors: [{ kind: "normal", scale: [1, 1, 1] }], centers: { bufferView: 0, drops: [0, 0, 0] } }), /texels do not support predictors/],
  "weights that are not packed": [(json) => delete extensionOf(json).packing, /not packed/],
  "no maps": [(json) => (extensionOf(json).maps = []), /the maps are invalid/],
  "a map without a size": [(json) => delete extensionOf(json).maps[0].width, /the maps are invalid/],
  "maps of different words": [(json) => extensionOf(json).maps[1].images.pop(), /different numbers of images/],
  "a missing image": [(json) => (extensionOf(json).maps[0].images[0] = 99), /an image of a map does not exist/],
  "too many words": [(json) => extensionOf(json).maps.forEach(({ images }) => images.push(images[0])), /a texel has 3 words, not 2/],
  "too few words": [(json) => extensionOf(json).maps.forEach(({ images }) => images.pop()), /a texel has 1 words, not 2/],
  "damaged bases": [(json) => (extensionOf(json).bases.bufferView = 0), /the bases do not contain \d+ floats/],
  "a missing buffer view": [(json) => (extensionOf(json).bases.bufferView = 999), /buffer view 999 cannot be read/],
  "an image of another size": [(json) => (extensionOf(json).maps[0].width = 64), /image 1 does not have the size of its map/],
  "an image that is not a PNG": [(json) => (json.images[1].bufferView = extensionOf(json).bases.bufferView), /image 1 is not a PNG with four channels of 8 bits/],
  "a short image": [(json, binary) => (json.images[1].bufferView = binary.view(png(96, 64, new Uint8Array(4 * 96 * 64)).subarray(0, 20))), /image 1 is not a PNG/],
  "a missing map": [(json) => (json.meshes[0].primitives[0].extensions.PRTKIT_lightmap.map = 7), /names a map that does not exist/],
  "coordinates that three does not support": [(json) => (json.meshes[0].primitives[0].extensions.PRTKIT_lightmap.texCoord = 4), /uses TEXCOORD_4 for its map; three supports/],
  "missing coordinates": [(json) => (json.meshes[0].primitives[0].extensions.PRTKIT_lightmap.texCoord = 2), /has no TEXCOORD_2/],
  "transfer of vertices and texels": [(json) => (json.extensions.PRTKIT_clustered_pca = {}), /also has transfer of texels/],
};
for (const [what, [change, message]] of Object.entries(refusals))
  test(`${what}: rejected with a reason`, async () => {
    await assert.rejects(load(change), (error) => {
      assert.match(error.message, /^PRTKIT_(lightmap|clustered_pca): /);
      assert.match(error.message, message);
      return true;
    });
  });

test("an image that cannot be decoded is reported", async () => {
  globalThis.createImageBitmap = async () => {
    throw new Error("broken");
  };
  await assert.rejects(load(), /PRTKIT_lightmap: image \d cannot be decoded/);
  globalThis.createImageBitmap = undefined;
  await assert.rejects(load(), /PRTKIT_lightmap: createImageBitmap is missing, so images cannot be decoded/);
});
