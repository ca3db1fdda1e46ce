// Tests files with transfer of texels: loading and rejection. renderers.mjs draws them.
import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import { ShaderLib } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { PrtkitPlugin, ShLight } from "../src/PrtkitLoader.js";
import { bakedModel, MAPS } from "./bakedModel.js";
import { png } from "./glb.js";
import { addSet, setIn } from "./transferSets.js";
import { PROBES, volumeSet } from "./volumeModel.js";

const { createImageBitmap } = globalThis;
globalThis.ProgressEvent ??= Event; // exists in browsers; three's FileLoader creates some
let asked;
beforeEach(() => {
  asked = [];
  globalThis.createImageBitmap = async (blob, options) => (asked.push(options), { blob });
});
afterEach(() => (globalThis.createImageBitmap = createImageBitmap));

/** The file, without textures for which node has no decoder; `by`: see bakedModel. */
function load(change = () => {}, by = "texels") {
  const file = bakedModel(by, (json, binary) => {
    delete json.textures;
    json.materials = json.materials.map(({ normalTexture: _, ...material }) => material);
    change(json, binary);
  });
  const loader = new GLTFLoader().register((parser) => new PrtkitPlugin(parser));
  return loader.parseAsync(file.buffer.slice(file.byteOffset, file.byteOffset + file.length), "");
}
const mapsOf = (json) => setIn(json, "texels").maps;
const placed = (json) => json.meshes[0].primitives[0].extensions.PRTKIT_transfer;

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

test("surfaces with transfer of texels and vertices show that of texels", async () => {
  const addFallback = (json) => {
    setIn(json, "vertices").fallback = { exposure: 0.5 };
    json.materials[1] = { ...json.materials[1], extensions: { KHR_materials_unlit: { extras: { prtkit: "fallback" } } } };
  };
  const { scene, userData } = await load((json, binary) => {
    addFallback(json);
    addSet(json, volumeSet(binary));
  }, "both");
  const { prtkit } = userData;
  assert.deepEqual([prtkit.vertices, prtkit.texels, prtkit.volume.probes], [0, MAPS[0].width * MAPS[0].height + MAPS[1].width * MAPS[1].height, PROBES]);
  for (const { geometry, material } of scene.children) {
    assert.ok(material.isMeshStandardMaterial && material.lightMap && material.defines.PRT_LIGHTMAP);
    assert.deepEqual(Object.keys(geometry.attributes).filter((name) => /prt/.test(name)), []);
  }
  const light = ShLight.fromCoefficients(3, new Array(27).fill(1));
  prtkit.setLight(light);
  const alone = (await load()).userData.prtkit;
  alone.setLight(light);
  assert.deepEqual(prtkit.constantsTexture.image.data, alone.constantsTexture.image.data);
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
  "a raw bake": [(json) => (setIn(json, "texels").coding = "raw"), /the file is an uncompressed bake; compress it: prt compress/],
  "predictors": [(json) => Object.assign(setIn(json, "texels"), { predictors: [{ kind: "normal", scale: [1, 1, 1] }], centers: { bufferView: 0, drops: [0, 0, 0] } }), /predictors are only for vertices/],
  "weights that are not packed": [(json) => delete setIn(json, "texels").packing, /not packed/],
  "no maps": [(json) => (setIn(json, "texels").maps = []), /the maps are invalid/],
  "a map without a size": [(json) => delete mapsOf(json)[0].width, /the maps are invalid/],
  "maps of different words": [(json) => mapsOf(json)[1].images.pop(), /different numbers of images/],
  "a missing image": [(json) => (mapsOf(json)[0].images[0] = 99), /an image of a map does not exist/],
  "too many words": [(json) => mapsOf(json).forEach(({ images }) => images.push(images[0])), /a texel has 3 words, not 2/],
  "too few words": [(json) => mapsOf(json).forEach(({ images }) => images.pop()), /a texel has 1 words, not 2/],
  "damaged bases": [(json) => (setIn(json, "texels").bases.bufferView = 0), /the bases do not contain \d+ floats/],
  "a missing buffer view": [(json) => (setIn(json, "texels").bases.bufferView = 999), /buffer view 999 cannot be read/],
  "an image of another size": [(json) => (mapsOf(json)[0].width = 64), /image 1 does not have the size of its map/],
  "an image that is not a PNG": [(json) => (json.images[1].bufferView = setIn(json, "texels").bases.bufferView), /image 1 is not a PNG with four channels of 8 bits/],
  "a short image": [(json, binary) => (json.images[1].bufferView = binary.view(png(96, 64, new Uint8Array(4 * 96 * 64)).subarray(0, 20))), /image 1 is not a PNG/],
  "a missing map": [(json) => (placed(json).map = 7), /names a map that does not exist/],
  "coordinates that three does not support": [(json) => (placed(json).texCoord = 4), /uses TEXCOORD_4 for its map; three supports/],
  "missing coordinates": [(json) => (placed(json).texCoord = 2), /has no TEXCOORD_2/],
};
for (const [what, [change, message]] of Object.entries(refusals))
  test(`${what}: rejected with a reason`, async () => {
    await assert.rejects(load(change), (error) => {
      assert.match(error.message, /^PRTKIT_transfer: texels: /);
      assert.match(error.message, message);
      return true;
    });
  });

test("an image that cannot be decoded is reported", async () => {
  globalThis.createImageBitmap = async () => {
    throw new Error("broken");
  };
  await assert.rejects(load(), /PRTKIT_transfer: texels: image \d cannot be decoded/);
  globalThis.createImageBitmap = undefined;
  await assert.rejects(load(), /PRTKIT_transfer: texels: createImageBitmap is missing, so images cannot be decoded/);
});
