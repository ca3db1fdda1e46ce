// Files with PRTKIT_lobes: reading, light and shaders. renderers.mjs draws them in poses.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Euler, Scene, ShaderLib } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { PrtkitPlugin, ShLight } from "../src/PrtkitLoader.js";
import { PrtkitPlugin as NodePlugin } from "../src/webgpu.js";
import { bakedModel, vertexSet } from "./bakedModel.js";
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
  ["additional transfer of one pose", (json, binary) => Object.assign(json.extensions, transferOf(vertexSet(binary, "vertices"))), /the file also has transfer that does not rotate/],
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
