// Files with PRTKIT_lobes: reading, light and shaders. renderers.mjs draws them in poses.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Euler, Scene, ShaderLib } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { PrtkitPlugin, ShLight } from "../src/PrtkitLoader.js";
import { PrtkitPlugin as NodePlugin } from "../src/webgpu.js";
import { bakedModel, vertexSet, wordsAt } from "./bakedModel.js";
import { ACROSS, DOWN, LOBES, lobeModel, PROFILES, profiles, squares } from "./lobeModel.js";
import { transferOf } from "./transferSets.js";
import { PROBES, volumeSet } from "./volumeModel.js";

const load = (file, Plugin = PrtkitPlugin) => {
  const loader = new GLTFLoader().register((parser) => new Plugin(parser));
  return loader.parseAsync(file.buffer.slice(file.byteOffset, file.byteOffset + file.length), "");
};
const light = ShLight.fromCoefficients(4, Array.from({ length: 48 }, (_, i) => Math.cos(3 * i + 1) + (i < 3 ? 3 : 0)));
const meshOf = ({ scene }) => scene.getObjectByProperty("isSkinnedMesh", true);

test("lobes and profiles equal those of the file", async () => {
  for (const order of [2, 4]) {
    const gltf = await load(lobeModel(order));
    const { prtkit } = gltf.userData;
    assert.deepEqual([prtkit.order, prtkit.lobes, prtkit.vertices, prtkit.bytesPerVertex], [order, LOBES, 4 * ACROSS * DOWN, 8]);
    const { image } = prtkit.profilesTexture;
    assert.deepEqual([image.width, image.height], [PROFILES, 1]);
    profiles(order).forEach((gains, p) =>
      [0, 1, 2, 3].forEach((band) => assert.equal(image.data[4 * p + band], Math.fround(gains[band] ?? 0))));
    const { attributes } = meshOf(gltf).geometry;
    const bytes = squares().flatMap(({ lobes }) => [0, 1, 2, 3].flatMap(() => lobes[1]));
    assert.deepEqual([...attributes.prt_lobe_1.array], bytes);
    assert.equal(attributes._prt_lobe_1, undefined);
  }
});

test("light is in world space for every rotation of the model and excludes separate suns", async () => {
  const gltf = await load(lobeModel());
  const { prtkit } = gltf.userData;
  const given = () => prtkit.uniforms.prtLobeLight.value.flatMap((value) => value.toArray());
  const isNear = (expected) => given().forEach((value, i) => assert.ok(Math.abs(value - expected[i]) < 1e-9));
  prtkit.setLight(light, 0.3);
  isNear([...light.coefficients(0.3)]);
  assert.equal(prtkit.uniforms.prtSeparateSuns.value, false);
  const scene = new Scene().add(gltf.scene);
  gltf.scene.rotation.set(0.3, 0.5, 0.1);
  scene.updateMatrixWorld(true);
  prtkit.setSky(light, scene, { suns: light });
  isNear([...light.coefficients()]);
  assert.equal(prtkit.uniforms.prtSeparateSuns.value, true);
  scene.backgroundRotation.copy(new Euler(0, 0.4, 0));
  prtkit.beforeRender();
  isNear([...light.coefficients(0.4)]);
  assert.throws(() => prtkit.setLight(ShLight.fromCoefficients(2, new Float64Array(12))), RangeError);
});

test("the shader rotates axes with three's skin matrix", async () => {
  const gltf = await load(lobeModel(3));
  const { material } = meshOf(gltf);
  assert.deepEqual([material.defines.PRT_LOBES, material.defines.PRT_LOBE_ORDER], [2, 3]);
  const shader = { uniforms: {}, vertexShader: ShaderLib.physical.vertexShader, fragmentShader: ShaderLib.physical.fragmentShader };
  material.onBeforeCompile(shader);
  assert.match(shader.vertexShader, /mat3 prt_lobe_rotation\(mat3 m\)/);
  // After three's skin matrix and the position of the vertex.
  assert.match(shader.vertexShader, /#include <skinnormal_vertex>[^]*prtMoved \* mat3\( skinMatrix \)[^]*prtRadiance = prtLobeRadiance\( prt_lobe_rotation\( prtMoved \), vec3\( 0\.0 \) \);/);
  assert.match(shader.vertexShader, /PRT_LOBE_PROFILE\(i\) texelFetch\( prt_lobe_profiles/);
  assert.doesNotMatch(shader.vertexShader, /vec3 prt_exit_radiance/);
  assert.doesNotMatch(shader.vertexShader, /#include "/);
  assert.equal(shader.uniforms.prtLobeLight, gltf.userData.prtkit.uniforms.prtLobeLight);
  assert.equal(material.clone().defines.PRT_LOBES, 2);
});

test("a volume may accompany lobes", async () => {
  const { prtkit } = (await load(lobeModel(4, (json, binary) => Object.assign(json.extensions, transferOf(volumeSet(binary)))))).userData;
  assert.deepEqual([prtkit.lobes, prtkit.volume.probes], [LOBES, PROBES]);
});

/** Adds a floor with transfer of vertices to the figure. */
function withFloor(json, binary) {
  Object.assign(json.extensions, transferOf(vertexSet(binary, "vertices")));
  const words = [[0, 0], [1, 0], [0, 1], [1, 1]].map(([u, v]) => wordsAt(u, v, 0));
  const attributes = {
    POSITION: binary.accessor(new Float32Array([-1, 0, -1, 1, 0, -1, -1, 0, 1, 1, 0, 1]), "VEC3", { min: [-1, 0, -1], max: [1, 0, 1] }),
    NORMAL: binary.accessor(new Float32Array([0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0]), "VEC3"),
  };
  for (const k of [0, 1])
    attributes[`_PRT_WEIGHTS_${k}`] = binary.accessor(new Uint8Array(new Uint32Array(words.map((word) => word[k])).buffer), "VEC4");
  json.meshes.push({ primitives: [{ attributes, indices: binary.accessor(new Uint32Array([0, 2, 1, 1, 2, 3]), "SCALAR"), material: 0 }] });
  json.nodes.push({ name: "floor", mesh: 1 });
  json.scenes[0].nodes.push(json.nodes.length - 1);
}

test("surfaces with transfer and a figure with lobes are lit as in two files", async () => {
  const both = await load(lobeModel(4, withFloor));
  const { prtkit } = both.userData;
  const alone = (await load(lobeModel())).userData.prtkit;
  const isFigure = ({ isSkinnedMesh }) => isSkinnedMesh === true;
  const meshes = [];
  both.scene.traverse((object) => object.isMesh && meshes.push(object));
  assert.equal(meshes.length, 2);
  for (const mesh of meshes) {
    assert.equal(mesh.material.defines.PRT_LOBES, isFigure(mesh) ? LOBES : undefined);
    assert.equal("prt_constants" in mesh.material._transfer.uniforms, !isFigure(mesh));
  }
  assert.deepEqual([prtkit.vertices, prtkit.figure.vertices], [4, alone.vertices]);
  prtkit.setLight(light, 0.3, null, { Lantern: 0.5 });
  alone.setLight(light, 0.3);
  assert.deepEqual(prtkit.figure.uniforms.prtLobeLight.value, alone.uniforms.prtLobeLight.value);
  const constants = [...prtkit.constantsTexture.image.data];
  assert.ok(constants.some((value) => value !== 0));
  prtkit.setSky(light, new Scene().add(both.scene), { suns: light });
  assert.equal(prtkit.figure.uniforms.prtSeparateSuns.value, true);
  let freed = 0;
  prtkit.figure.profilesTexture.addEventListener("dispose", () => ++freed);
  prtkit.dispose();
  assert.equal(freed, 1);
});

test("tables are freed", async () => {
  const { prtkit } = (await load(lobeModel())).userData;
  let freed = 0;
  prtkit.profilesTexture.addEventListener("dispose", () => ++freed);
  prtkit.dispose();
  assert.equal(freed, 1);
});

test("WebGPURenderer is rejected", async () => {
  await assert.rejects(load(lobeModel(), NodePlugin), /^Error: PRTKIT_lobes: WebGPURenderer is not supported; use WebGLRenderer/);
});

const lobesOf = (json) => json.extensions.PRTKIT_lobes;

for (const [what, change, message] of [
  ["another version", (json) => (lobesOf(json).version = 2), /version 2 is not supported/],
  ["not an object", (json) => (json.extensions.PRTKIT_lobes = 7), /is not an object/],
  ["too many bands", (json) => (lobesOf(json).order = 5), /the order is not 2 to 4/],
  ["too many lobes", (json) => (lobesOf(json).lobes = 4), /the order is not 2 to 4, or the number of lobes is not 1 to 3/],
  ["more lobes than vertices have", (json) => (lobesOf(json).lobes = 3), /a primitive has no _PRT_LOBE_2/],
  ["too many profiles", (json) => (lobesOf(json).profiles.count = 257), /the profiles are not 1 to 256/],
  ["fewer profiles", (json) => (lobesOf(json).profiles.count = 8), /the profiles are not 8 times 4 floats/],
  ["missing profiles", (json) => (lobesOf(json).profiles.bufferView = 99), /buffer view 99 cannot be read/],
  ["profiles that are not finite", (json, binary) => {
    lobesOf(json).profiles.bufferView = binary.view(new Float32Array(4 * PROFILES).fill(NaN));
  }, /profiles are not finite/],
  ["a missing profile", (json, binary) => {
    lobesOf(json).profiles = { bufferView: binary.view(new Float32Array(4)), count: 1 };
  }, /vertex \d+ names a profile that does not exist/],
  ["lobes of floats", (json, binary) => {
    json.meshes[0].primitives[0].attributes._PRT_LOBE_0 = binary.accessor(new Float32Array(16 * ACROSS * DOWN), "VEC4");
  }, /a primitive has no _PRT_LOBE_0 of four bytes/],
  ["fewer lobes", (json, binary) => {
    json.meshes[0].primitives[0].attributes._PRT_LOBE_0 = binary.accessor(new Uint8Array(16), "VEC4");
  }, /a primitive has no _PRT_LOBE_0 of four bytes/],
])
  test(`${what}: rejected with a reason`, async () => {
    await assert.rejects(load(lobeModel(4, change)), (error) => {
      assert.match(error.message, /^PRTKIT_lobes: /);
      assert.match(error.message, message);
      return true;
    });
  });

test("a bake without lobes is unchanged", async () => {
  const { userData } = await load(bakedModel("vertices", (json) => {
    json.materials = json.materials.map(({ normalTexture: _, ...material }) => material);
    delete json.images;
    delete json.textures;
  }));
  assert.equal(userData.prtkit.lobes, undefined);
});
