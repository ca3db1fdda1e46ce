// The plug-in against a parser that hands out what GLTFLoader does.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  FloatType,
  Group,
  HalfFloatType,
  DataUtils,
  Mesh,
  MeshStandardMaterial,
  RGBAFormat,
} from "three";
import { PrtkitPlugin, projectEquirectangular } from "../src/PrtkitLoader.js";

const white = () => projectEquirectangular(new DataTexture(new Float32Array([1, 1, 1, 1]), 1, 1, RGBAFormat, FloatType));

function bytesOf(...values) {
  return new Float32Array(values).buffer;
}

function scene(attributes, extension) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(6), 3));
  for (const [name, attribute] of Object.entries(attributes)) geometry.setAttribute(name, attribute);
  const mesh = new Mesh(geometry, new MeshStandardMaterial({ color: 0xff0000, alphaTest: 0.25 }));
  const group = new Group().add(mesh);
  const parser = {
    json: { extensions: extension ? { PRTKIT_clustered_pca: extension } : {} },
    associations: new Map([[mesh, { meshes: 0, primitives: 0 }]]),
    getDependency: async (kind, i) => [bytesOf(2, 0.5), new Uint8Array([7]).buffer][i],
  };
  return { gltf: { scenes: [group], scene: group, userData: {} }, parser, mesh };
}

const packed = {
  version: 2,
  order: 1,
  channels: 1,
  components: [1],
  bases: { bufferView: 0, componentType: 5126 },
  packing: { clusterBits: 0, bufferView: 1 }, // one weight of 8 bits
};

test("packed weights become words, and the material keeps its colour", async () => {
  const bytes = new BufferAttribute(new Uint8Array([1, 2, 3, 4, 250, 0, 0, 128]), 4);
  const { gltf, parser, mesh } = scene({ _prt_weights_0: bytes }, packed);
  await new PrtkitPlugin(parser).afterRoot(gltf);
  assert.deepEqual([...mesh.geometry.getAttribute("prt_words_0").array], [0x04030201, 0x800000fa]);
  assert.equal(mesh.geometry.getAttribute("_prt_weights_0"), undefined);
  assert.equal(mesh.material.type, "MeshBasicMaterial");
  assert.equal(mesh.material.color.getHex(), 0xff0000);
  assert.equal(mesh.material.alphaTest, 0.25);
  assert.deepEqual(mesh.material.defines.PRT_PACKED_WORDS, 1);
  const model = gltf.userData.prtkit;
  assert.equal(model.bytesPerVertex, 4);
  assert.equal(model.vertices, 2);
  model.setLight(white());
  // mean - direction, and 2 / 255 direction, times L_0 = sqrt(4 pi)
  const constants = model.constantsTexture.image.data;
  const l0 = Math.sqrt(4 * Math.PI);
  assert.ok(Math.abs(constants[0] - 1.5 * l0) < 1e-5);
  assert.ok(Math.abs(constants[4] - ((2 * 0.5) / 255) * l0) < 1e-6);
});

test("weights that are not packed stay as they are, beside the cluster", async () => {
  const { packing, ...extension } = packed;
  const weights = new BufferAttribute(new Int8Array(8), 4, true);
  const cluster = new BufferAttribute(new Uint8Array([0, 0]), 1);
  const { gltf, parser, mesh } = scene({ _prt_weights_0: weights, _prt_cluster: cluster }, extension);
  await new PrtkitPlugin(parser).afterRoot(gltf);
  assert.equal(mesh.geometry.getAttribute("prt_weights_0"), weights);
  assert.ok(mesh.geometry.getAttribute("prt_cluster").array instanceof Uint32Array);
  assert.equal(gltf.userData.prtkit.bytesPerVertex, 2);
});

test("files without the extension are left alone", async () => {
  const { gltf, parser, mesh } = scene({}, null);
  const { material } = mesh;
  await new PrtkitPlugin(parser).afterRoot(gltf);
  assert.equal(mesh.material, material);
  assert.equal(gltf.userData.prtkit, undefined);
});

test("a light of fewer bands than the model is refused", async () => {
  const bytes = new BufferAttribute(new Uint8Array(8), 4);
  const { gltf, parser } = scene({ _prt_weights_0: bytes }, packed);
  await new PrtkitPlugin(parser).afterRoot(gltf);
  assert.throws(() => gltf.userData.prtkit.setLight({ order: 0 }), RangeError);
});

test("the shader is that of the runtime", async () => {
  const bytes = new BufferAttribute(new Uint8Array(8), 4);
  const { gltf, parser, mesh } = scene({ _prt_weights_0: bytes }, packed);
  await new PrtkitPlugin(parser).afterRoot(gltf);
  const shader = {
    uniforms: {},
    vertexShader: "#include <common>\nvoid main() {\n#include <begin_vertex>\n}",
    fragmentShader: "#include <common>\nvoid main() {\n#include <opaque_fragment>\n}",
  };
  mesh.material.onBeforeCompile(shader);
  assert.match(shader.vertexShader, /vec3 prt_exit_radiance\(\)/);
  assert.match(shader.vertexShader, /prtRadiance = prt_exit_radiance\(\);/);
  assert.doesNotMatch(shader.vertexShader, /#include "/);
  assert.match(shader.fragmentShader, /outgoingLight \*= max\(prtRadiance/);
});

test("half floats and three channels are read", () => {
  const half = new DataTexture(new Uint16Array([1, 2, 4, 1].map(DataUtils.toHalfFloat)), 1, 1, RGBAFormat, HalfFloatType);
  const light = projectEquirectangular(half, 2);
  assert.ok(Math.abs(light.polar[2] - 4 * Math.sqrt(4 * Math.PI)) < 1e-5);
});
