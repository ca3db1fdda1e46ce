// Tests the plug-in with a parser that returns the same data as GLTFLoader.
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
  MeshBasicMaterial,
  MeshPhysicalMaterial,
  MeshStandardMaterial,
  RGBAFormat,
  DoubleSide,
  ShaderChunk,
  ShaderLib,
} from "three";
import { halfFloatSky, PrtkitPlugin, projectEquirectangular } from "../src/PrtkitLoader.js";
import { transferOf } from "./transferSets.js";

const white = () => projectEquirectangular(new DataTexture(new Float32Array([1, 1, 1, 1]), 1, 1, RGBAFormat, FloatType));

function bytesOf(...values) {
  return new Float32Array(values).buffer;
}

function scene(attributes, extension, material = {}) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(6), 3));
  for (const [name, attribute] of Object.entries(attributes)) geometry.setAttribute(name, attribute);
  const mesh = new Mesh(geometry, new MeshStandardMaterial({ color: 0xff0000, alphaTest: 0.25 }));
  const group = new Group().add(mesh);
  const parser = {
    json: {
      extensions: extension ? transferOf(extension) : {},
      meshes: [{ primitives: [{ material: 0 }] }],
      materials: [material],
    },
    associations: new Map([[mesh, { meshes: 0, primitives: 0 }]]),
    getDependency: async (kind, i) => [bytesOf(2, 0.5), new Uint8Array([7]).buffer][i],
  };
  return { gltf: { scenes: [group], scene: group, userData: {} }, parser, mesh };
}

const packed = {
  receivers: "vertices",
  coding: "clustered",
  order: 1,
  terms: [{ kind: "combined", channels: 1 }],
  components: [1],
  bases: { bufferView: 0, componentType: 5126 },
  packing: { clusterBits: 0, bufferView: 1 }, // one weight of 8 bits
};

const loading = (attributes, extension) => {
  const { gltf, parser } = scene(attributes, extension);
  return new PrtkitPlugin(parser).afterRoot(gltf);
};

test("weights that do not match the vertices are rejected with a reason", async () => {
  const bytes = (...values) => new BufferAttribute(new Uint8Array(values), 4);
  await assert.rejects(loading({ _prt_weights_0: bytes(1, 2, 3, 4) }, packed), /in type or number/);
  await assert.rejects(loading({ _prt_other: bytes(0, 0, 0, 0, 0, 0, 0, 0) }, packed), /0 groups of weights, not 1/);
  const floats = new BufferAttribute(new Float32Array(8), 4);
  await assert.rejects(loading({ _prt_weights_0: floats }, packed), /not unsigned bytes/);
  const two = { ...packed, packing: { clusterBits: 3, bufferView: 1 } };
  await assert.rejects(loading({ _prt_weights_0: bytes(0, 0, 0, 0, 5, 0, 0, 0) }, two), /vertex 1 names a cluster that does not exist/);
});

test("invalid clusters and weights are rejected with a reason", async () => {
  const plain = { ...packed, packing: undefined };
  const cluster = (...values) => new BufferAttribute(new Uint8Array(values), 1);
  const weights = (value) => new BufferAttribute(new Float32Array(8).fill(value), 4);
  await assert.rejects(loading({ _prt_weights_0: weights(0) }, plain), /has no _PRT_CLUSTER/);
  await assert.rejects(loading({ _prt_weights_0: weights(0), _prt_cluster: cluster(0) }, plain), /has no _PRT_CLUSTER/);
  await assert.rejects(loading({ _prt_weights_0: weights(0), _prt_cluster: cluster(0, 1) }, plain), /vertex 1 names a cluster that does not exist/);
  for (const wrong of [NaN, 2e9])
    await assert.rejects(loading({ _prt_weights_0: weights(wrong), _prt_cluster: cluster(0, 0) }, plain), /weights are not finite/);
  for (const [Stored, reason] of [
    [Int8Array, /weights 'snorm8' are not supported: compress again with prt compress/],
    [Int16Array, /weights 'snorm16' are not supported: compress again with prt compress/],
    [Uint8Array, /the weights are not floats/],
  ]) {
    const integers = new BufferAttribute(new Stored(8), 4, true);
    await assert.rejects(loading({ _prt_weights_0: integers, _prt_cluster: cluster(0, 0) }, plain), reason);
  }
});

test("packed weights become words, and the material keeps its colour", async () => {
  const bytes = new BufferAttribute(new Uint8Array([1, 2, 3, 4, 250, 0, 0, 128]), 4);
  const { gltf, parser, mesh } = scene({ _prt_weights_0: bytes }, packed);
  await new PrtkitPlugin(parser).afterRoot(gltf);
  assert.deepEqual([...mesh.geometry.getAttribute("prt_words_0").array], [0x04030201, 0x800000fa]);
  assert.equal(mesh.geometry.getAttribute("_prt_weights_0"), undefined);
  assert.equal(mesh.material.type, "MeshStandardMaterial");
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

test("unpacked weights are unchanged, in addition to the cluster", async () => {
  const { packing: _packing, ...extension } = packed;
  const weights = new BufferAttribute(new Float32Array(8), 4);
  const cluster = new BufferAttribute(new Uint8Array([0, 0]), 1);
  const { gltf, parser, mesh } = scene({ _prt_weights_0: weights, _prt_cluster: cluster }, extension);
  await new PrtkitPlugin(parser).afterRoot(gltf);
  assert.equal(mesh.geometry.getAttribute("prt_weights_0"), weights);
  assert.ok(mesh.geometry.getAttribute("prt_cluster").array instanceof Uint32Array);
  assert.equal(gltf.userData.prtkit.bytesPerVertex, 4 + 16); // a word, and one weight in a vector of four
});

test("bytes per vertex are those of the bound attributes", async () => {
  const { packing: _packing, ...extension } = { ...packed, components: [5], bases: { bufferView: 0, componentType: 5126 } };
  const attributes = {
    _prt_weights_0: new BufferAttribute(new Float32Array(8), 4),
    _prt_weights_1: new BufferAttribute(new Float32Array(8), 4),
    _prt_cluster: new BufferAttribute(new Uint8Array([0, 0]), 1),
  };
  const { gltf, parser, mesh } = scene(attributes, extension);
  parser.getDependency = async () => bytesOf(...new Array(6).fill(1)); // mean and five directions
  await new PrtkitPlugin(parser).afterRoot(gltf);
  const names = ["prt_cluster", "prt_weights_0", "prt_weights_1"];
  const bound = names.map((name) => mesh.geometry.getAttribute(name).array.byteLength);
  assert.equal(gltf.userData.prtkit.bytesPerVertex, bound.reduce((a, b) => a + b) / 2);
  assert.equal(gltf.userData.prtkit.bytesPerVertex, 4 + 2 * 4 * 4);
});

test("tables longer than a texture row continue in the next row", async () => {
  const count = 300; // clusters without components: one row of constants each
  const { packing: _packing, ...extension } = { ...packed, components: new Array(count).fill(0) };
  const cluster = new BufferAttribute(new Uint16Array([0, count - 1]), 1);
  const { gltf, parser } = scene({ _prt_cluster: cluster }, extension);
  parser.getDependency = async () => bytesOf(...Array.from({ length: count }, (_, k) => k));
  await new PrtkitPlugin(parser).afterRoot(gltf);
  const { constantsTexture, clustersTexture } = gltf.userData.prtkit;
  gltf.userData.prtkit.setLight(white());
  for (const { image } of [constantsTexture, clustersTexture]) {
    assert.equal(image.data.length, 4 * image.width * image.height);
    assert.ok(image.width * image.height >= count && image.width * (image.height - 1) < count);
  }
  for (let k = 0; k < count; ++k) {
    assert.equal(clustersTexture.image.data[4 * k], k);
    assert.ok(Math.abs(constantsTexture.image.data[4 * k] - k * Math.sqrt(4 * Math.PI)) < 1e-3);
  }
});

test("files without the extension are unchanged", async () => {
  const { gltf, parser, mesh } = scene({}, null);
  const { material } = mesh;
  await new PrtkitPlugin(parser).afterRoot(gltf);
  assert.equal(mesh.material, material);
  assert.equal(gltf.userData.prtkit, undefined);
});

test("a light of fewer bands than the model is rejected", async () => {
  const bytes = new BufferAttribute(new Uint8Array(8), 4);
  const { gltf, parser } = scene({ _prt_weights_0: bytes }, packed);
  await new PrtkitPlugin(parser).afterRoot(gltf);
  assert.throws(() => gltf.userData.prtkit.setLight({ order: 0 }), RangeError);
  const enough = { order: 1, coefficients: () => [1, 1, 1] };
  assert.throws(() => gltf.userData.prtkit.setLight(enough, 0, { order: 0 }), RangeError);
  gltf.userData.prtkit.setLight(enough);
});

/** Compiles a material as three does. */
function compiled({ onBeforeCompile, isMeshLambertMaterial }) {
  const { vertexShader, fragmentShader } = isMeshLambertMaterial ? ShaderLib.lambert : ShaderLib.physical;
  const shader = { uniforms: {}, vertexShader, fragmentShader };
  onBeforeCompile(shader);
  return shader;
}

test("the shader contains the runtime's functions and three's material", async () => {
  const bytes = new BufferAttribute(new Uint8Array(8), 4);
  const { gltf, parser, mesh } = scene({ _prt_weights_0: bytes }, packed);
  await new PrtkitPlugin(parser).afterRoot(gltf);
  const shader = compiled(mesh.material);
  assert.match(shader.vertexShader, /vec3 prt_exit_radiance\(vec3 position, vec3 normal\)/);
  assert.match(shader.vertexShader, /prtRadiance = prt_exit_radiance\(prtBakedPosition\(\), prtBakedNormal\(\)\);/);
  assert.doesNotMatch(shader.vertexShader, /#include "/);
  // After skins and morph targets, which move the lookup of a pixel in a shadow map.
  assert.match(shader.vertexShader, /#include <skinning_vertex>[^]*prtLight\( transformed \);/);
  // Three's lights add only suns; ambient light is omitted.
  assert.doesNotMatch(shader.fragmentShader, /#if \( NUM_\w+_LIGHTS > 0 \) && defined\( RE_Direct/);
  assert.doesNotMatch(shader.fragmentShader, /getAmbientLightIrradiance/);
  assert.doesNotMatch(shader.fragmentShader, /indirectDiffuse \*= ambientOcclusion/);
  assert.match(shader.fragmentShader, /directLight\.color \*= PRT_VISIBILITY/);
  for (const chunk of ["normal_fragment_maps", "lights_fragment_maps", "lights_fragment_end", "fog_fragment", "tonemapping_fragment"])
    assert.ok(shader.fragmentShader.includes(`#include <${chunk}>`), chunk);
});

test("a clone of a material is lit equally and keeps its own colour", async () => {
  const { gltf, parser, mesh } = scene({ _prt_weights_0: new BufferAttribute(new Uint8Array(8), 4) }, packed);
  await new PrtkitPlugin(parser).afterRoot(gltf);
  const clone = mesh.material.clone().clone();
  assert.notEqual(clone, mesh.material);
  clone.color.set(0x00ff00);
  assert.equal(mesh.material.color.getHex(), 0xff0000);
  assert.deepEqual(clone.defines, mesh.material.defines);
  assert.equal(clone.customProgramCacheKey(), mesh.material.customProgramCacheKey());
  assert.equal(compiled(clone).uniforms.prt_constants, compiled(mesh.material).uniforms.prt_constants);
  assert.equal(clone.onBeforeRender, mesh.material.onBeforeRender);
  assert.equal(gltf.scene.clone().children[0].material, mesh.material);
});

test("materials keep the properties that three uses; unlit ones become matte", async () => {
  for (const [material, type] of [
    [new MeshPhysicalMaterial({ clearcoat: 0.5, roughness: 0.3 }), "MeshPhysicalMaterial"],
    [new MeshBasicMaterial({ color: 0x0000ff }), "MeshLambertMaterial"],
  ]) {
    const { gltf, parser, mesh } = scene({ _prt_weights_0: new BufferAttribute(new Uint8Array(8), 4) }, packed);
    mesh.material = material;
    await new PrtkitPlugin(parser).afterRoot(gltf);
    assert.equal(mesh.material.type, type);
    assert.equal(mesh.material.clearcoat, material.clearcoat);
    assert.equal(mesh.material.roughness, material.roughness);
    assert.deepEqual(mesh.material.color, material.color);
    assert.match(compiled(mesh.material).fragmentShader, /prtRadiance/);
  }
});

test("dispose frees the tables", async () => {
  const { gltf, parser } = scene({ _prt_weights_0: new BufferAttribute(new Uint8Array(8), 4) }, packed);
  await new PrtkitPlugin(parser).afterRoot(gltf);
  const freed = [];
  for (const name of ["constantsTexture", "clustersTexture"])
    gltf.userData.prtkit[name].addEventListener("dispose", () => freed.push(name));
  gltf.userData.prtkit.dispose();
  assert.deepEqual(freed, ["constantsTexture", "clustersTexture"]);
});

test("two models have separate lights", async () => {
  const models = [];
  for (const factor of [1, 3]) {
    const { gltf, parser, mesh } = scene({ _prt_weights_0: new BufferAttribute(new Uint8Array(8), 4) }, packed);
    await new PrtkitPlugin(parser).afterRoot(gltf);
    gltf.userData.prtkit.setLight(white().times(factor));
    models.push(compiled(mesh.material).uniforms.prt_constants.value.image.data[0]);
  }
  assert.ok(Math.abs(models[1] / models[0] - 3) < 1e-6);
});

test("predictors get the space of the bake from the node of each mesh", async () => {
  const predictors = [{ kind: "normal", scale: [1, 2, 3] }, { kind: "position", origin: [1, 2, 3], scale: [1, 1, 1] }];
  const extension = { ...packed, predictors, centers: { bufferView: 2, drops: [0, 0, 0, 0, 0, 0] } };
  const { gltf, parser, mesh } = scene({ _prt_weights_0: new BufferAttribute(new Uint8Array(8), 4) }, extension);
  mesh.geometry.setAttribute("normal", new BufferAttribute(new Float32Array([0, 0, 1, 0, 1, 0]), 3));
  mesh.geometry.getAttribute("position").setXYZ(1, 1, 1, 1);
  mesh.position.set(5, 6, 7);
  const views = [bytesOf(2, 1, 1, 1, 1, 1, 1, 0.5), new Uint8Array([7]).buffer, new Uint8Array(5).buffer];
  parser.getDependency = async (kind, i) => views[i];
  await new PrtkitPlugin(parser).afterRoot(gltf);
  assert.equal(mesh.material.defines.PRT_PREDICTOR_NORMAL, 1);
  assert.equal(mesh.material.defines.PRT_PREDICTOR_POSITION, 1);
  const { uniforms } = compiled(mesh.material);
  assert.deepEqual(uniforms.prtToBake.value.elements.slice(12, 15), [4, 4, 4]);
  assert.deepEqual(uniforms.prtNormalToBake.value.elements, [1, 0, 0, 0, 1, 0, 0, 0, 1]);
  const model = gltf.userData.prtkit;
  model.setLight(white());
  const l0 = Math.sqrt(4 * Math.PI);
  const constants = model.constantsTexture.image.data;
  [1.5, 1, 2, 3, 1, 1, 1, 1 / 255].forEach((row, r) => assert.ok(Math.abs(constants[4 * r] - row * l0) < 1e-5, `${r}`));
});

const separate = { ...packed, terms: [{ kind: "direct", channels: 1 }] };

test("directional lights light models with a direct term while suns are separate", async () => {
  const light = white();
  const weights = () => ({ _prt_weights_0: new BufferAttribute(new Uint8Array(8), 4) });
  for (const [extension, lit] of [[separate, true], [packed, false]]) {
    const { gltf, parser, mesh } = scene(weights(), extension);
    await new PrtkitPlugin(parser).afterRoot(gltf);
    const model = gltf.userData.prtkit;
    assert.equal(model.hasDirectTerm, lit);
    assert.equal(Boolean(mesh.material.defines.PRT_SUNS), lit);
    assert.equal(mesh.receiveShadow && mesh.castShadow, lit);
    const { prtSeparateSuns } = compiled(mesh.material).uniforms;
    model.setLight(light);
    assert.equal(prtSeparateSuns.value, false);
    model.setLight(light, 0, light);
    assert.equal(prtSeparateSuns.value, lit);
    // Direct transfer does not include the suns, combined transfer does.
    const l0 = Math.sqrt(4 * Math.PI);
    assert.ok(Math.abs(model.constantsTexture.image.data[0] - (lit ? 1 : 2) * 1.5 * l0) < 1e-5);
    model.setLight(light);
    assert.equal(prtSeparateSuns.value, false);
  }
});

const WITH_LAMPS = {
  receivers: "vertices",
  coding: "clustered",
  order: 1,
  terms: [{ kind: "direct", channels: 1 }, { kind: "lamp", channels: 1, name: "Lantern" }, { kind: "lamp", channels: 3, name: "Sign" }],
  components: [0],
  bases: { bufferView: 0, componentType: 5126 },
};

test("lamps and emissive materials are dimmed and coloured by name", async () => {
  const attributes = () => ({ _prt_cluster: new BufferAttribute(new Uint8Array(2), 1) });
  const { gltf, parser, mesh } = scene(attributes(), WITH_LAMPS, { name: "Sign" });
  mesh.material.emissive.setRGB(0.5, 0.25, 1);
  mesh.material.emissiveIntensity = 8;
  parser.getDependency = async () => bytesOf(2, 3, 5, 7, 11);
  await new PrtkitPlugin(parser).afterRoot(gltf);
  const model = gltf.userData.prtkit;
  assert.deepEqual(model.lamps, ["Lantern", "Sign"]);
  const { prtStrength } = compiled(mesh.material).uniforms;
  const l0 = 2 * Math.sqrt(4 * Math.PI);
  const lit = (...expected) => {
    const [red, green, blue] = model.constantsTexture.image.data;
    [red, green, blue].forEach((value, c) => assert.ok(Math.abs(value - l0 - expected[c]) < 1e-5, `${value - l0}, not ${expected[c]}`));
  };
  model.setLight(white());
  lit(3 + 5, 3 + 7, 3 + 11);
  assert.deepEqual(prtStrength.value.toArray(), [1, 1, 1]);
  model.setLight(white(), 0, null, { Sign: [1, 0, 0.5], Lantern: 2 });
  lit(6 + 5, 6, 6 + 5.5);
  assert.deepEqual(prtStrength.value.toArray(), [1, 0, 0.5]);
  model.setLight(white(), 0, null, { Lantern: 0 }); // the other lamp has the strength of the scene again
  lit(5, 7, 11);
  assert.deepEqual(prtStrength.value.toArray(), [1, 1, 1]);
  assert.equal(mesh.material.emissiveIntensity, 8);
  assert.deepEqual(mesh.material.emissive.toArray(), [0.5, 0.25, 1]);
  for (const bad of [{ Moon: 1 }, { Sign: -1 }, { Sign: NaN }, { Sign: [1, 2] }, { Sign: [1, 2, -3] }, { Sign: Infinity }, { Sign: null }])
    assert.throws(() => model.setLight(white(), 0, null, bad), RangeError);
  lit(5, 7, 11); // a rejected light changes nothing
});

test("emissive materials are dimmed with their group", async () => {
  const [sky, lantern, sign] = WITH_LAMPS.terms;
  const terms = [sky, lantern, { ...sign, name: "Street", members: ["Tube", "material 0"] }];
  for (const [material, expected] of [["Tube", 0.5], ["", 0.5], ["Street", 1], ["Lantern", 2]]) {
    const attributes = { _prt_cluster: new BufferAttribute(new Uint8Array(2), 1) };
    const { gltf, parser, mesh } = scene(attributes, { ...WITH_LAMPS, terms }, { name: material });
    parser.getDependency = async () => bytesOf(2, 3, 5, 7, 11);
    await new PrtkitPlugin(parser).afterRoot(gltf);
    gltf.userData.prtkit.setLight(white(), 0, null, { Street: 0.5, Lantern: 2 });
    assert.equal(compiled(mesh.material).uniforms.prtStrength.value.x, expected, material);
  }
});

test("suns pass through thin sheets and glass, not into media", async () => {
  const sheet = { KHR_materials_diffuse_transmission: { diffuseTransmissionFactor: 0.25, diffuseTransmissionColorFactor: [1, 0.5, 0] } };
  const wax = { ...sheet, KHR_materials_volume: { thicknessFactor: 1, attenuationDistance: 0.1 } };
  const glass = { KHR_materials_transmission: { transmissionFactor: 0.9 } };
  for (const [material, lit, casts, transmission] of [
    [{}, true, true, [1, 1, 1, 0]],
    [{ extensions: sheet }, true, true, [1, 0.5, 0, 0.25]],
    [{ extensions: wax }, false, true, [1, 0.5, 0, 0.25]],
    [{ extensions: glass }, true, false, [1, 1, 1, 0]],
    [{ alphaMode: "BLEND" }, true, false, [1, 1, 1, 0]],
  ]) {
    const { gltf, parser, mesh } = scene({ _prt_weights_0: new BufferAttribute(new Uint8Array(8), 4) }, separate, material);
    await new PrtkitPlugin(parser).afterRoot(gltf);
    assert.equal(Boolean(mesh.material.defines.PRT_SUNS), lit);
    assert.equal(mesh.castShadow, casts);
    assert.deepEqual(compiled(mesh.material).uniforms.prtTransmission.value.toArray(), transmission);
    assert.equal(mesh.material.shadowSide, DoubleSide);
  }
});

test("half floats and three channels are read", () => {
  const half = new DataTexture(new Uint16Array([1, 2, 4, 1].map(DataUtils.toHalfFloat)), 1, 1, RGBAFormat, HalfFloatType);
  const light = projectEquirectangular(half, 2);
  assert.ok(Math.abs(light.polar[2] - 4 * Math.sqrt(4 * Math.PI)) < 1e-5);
});

/**
 * Returns the direction of the texel in which three's shaders look up `direction`, after checking their
 * equirectUv.
 */
function threeTexel([x, y, z], width, height) {
  const text = ShaderChunk.common.replace(/\s+/g, " ");
  assert.ok(text.includes("float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;"), "three looks up u differently");
  assert.ok(text.includes("float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;"), "three looks up v differently");
  const u = Math.atan2(z, x) / (2 * Math.PI) + 0.5;
  const v = Math.asin(y) / Math.PI + 0.5; // from the last row of a texture that is flipped
  return [Math.floor(u * width), height - 1 - Math.floor(v * height)];
}

/** Returns a texture as HDRLoader creates it, black except for the texel that three shows in `direction`. */
function brightTowards(direction, value = 1000, width = 128) {
  const height = 64;
  const data = new Float32Array(4 * width * height);
  const [x, y] = threeTexel(direction, width, height);
  data.set([value, value, value, 1], 4 * (y * width + x));
  const texture = new DataTexture(data, width, height, RGBAFormat, FloatType);
  texture.flipY = true;
  return texture;
}

/** Returns the direction of most light: bands 0 and 1 contain -y, z, -x. */
function mainDirection(light, angle) {
  const c = light.coefficients(angle);
  const d = [-c[9], -c[3], c[6]];
  return d.map((value) => value / Math.hypot(...d));
}

const unit = (d) => d.map((value) => value / Math.hypot(...d));

test("light comes from the direction in which three shows the texel", () => {
  for (const direction of [[1, 0, 0], [0, 0, 1], [-1, 0, 0.01], [0, 0, -1], [0.3, 0.5, -0.8], [-0.7, -0.6, 0.4]].map(unit)) {
    const found = mainDirection(projectEquirectangular(brightTowards(direction), 4));
    const cosine = found[0] * direction[0] + found[1] * direction[1] + found[2] * direction[2];
    assert.ok(cosine > Math.cos((3 * Math.PI) / 180), `${found} is not ${direction}`); // texels of 2.8 degrees
  }
});

test("the centre of images in OpenEXR's layout faces +Z", () => {
  const texture = brightTowards([1, 0, 0]); // three's middle
  const found = mainDirection(projectEquirectangular(texture, 4, { center: "z" }));
  assert.ok(found[2] > 0.998, `${found}`);
  assert.throws(() => projectEquirectangular(texture, 4, { center: "y" }), RangeError);
});

test("a sky for three's materials is finite in half floats", () => {
  const sun = brightTowards(unit([0.1, 1, 0]), 118735);
  const sky = halfFloatSky(sun);
  const values = [...sky.image.data].map(DataUtils.fromHalfFloat);
  assert.equal(Math.max(...values), 65504);
  assert.equal(sky.flipY, sun.flipY);
  // All other values and their positions are unchanged.
  const dim = projectEquirectangular(halfFloatSky(brightTowards(unit([0.3, 0.5, -0.8]), 100)), 4).polar;
  projectEquirectangular(brightTowards(unit([0.3, 0.5, -0.8]), 100), 4).polar.forEach((value, i) =>
    assert.ok(Math.abs(value - dim[i]) < 1e-6));
});

test("a sky in OpenEXR's layout is shown in the directions from which it lights", () => {
  for (const width of [128, 126]) {
    const texture = brightTowards([1, 0, 0], 100, width); // in the middle
    const lit = mainDirection(projectEquirectangular(texture, 4, { center: "z" }));
    const shown = mainDirection(projectEquirectangular(halfFloatSky(texture, { center: "z" }), 4));
    lit.forEach((value, i) => assert.ok(Math.abs(value - shown[i]) < 0.01, `${width}: ${shown} is not ${lit}`));
  }
});
