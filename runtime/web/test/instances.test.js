// Files with PRTKIT_instances: modes, constants, nodes and shaders against plain arithmetic of docs/format.md. renderers.mjs draws.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Box3, Matrix3, Matrix4, Quaternion, ShaderLib, Vector3 } from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { instanceRotations, InstanceModes } from "../src/instanceModes.js";
import { PrtkitPlugin, ShLight } from "../src/PrtkitLoader.js";
import { evaluateSh, gaussLegendre } from "../src/sphericalHarmonics.js";
import { PrtkitPlugin as NodePlugin } from "../src/webgpu.js";
import { texelSet } from "./bakedModel.js";
import { BOXES, bytes, COUNT, factors, instanceModel, lampBytes, lampNumber, LAMPS, PLACES, SCALES } from "./instanceModel.js";
import { addSet, setIn } from "./transferSets.js";

const load = (file, Plugin = PrtkitPlugin) => {
  const loader = new GLTFLoader().register((parser) => new Plugin(parser));
  return loader.parseAsync(file.buffer.slice(file.byteOffset, file.byteOffset + file.length), "");
};
const lightOf = (order, seed) =>
  ShLight.fromCoefficients(order, Array.from({ length: 3 * order * order }, (_, i) => Math.cos(seed * i + 1) + (i < 3 ? 3 : 0)));
const near = (value, expected, most, what = "") => assert.ok(Math.abs(value - expected) <= most, `${what} ${value}, not ${expected}`);

/**
 * Calls `take(direction, solid angle)` with a quadrature that is exact for low polynomials over each half of
 * the sphere.
 */
function overHalves(take) {
  const { nodes, weights } = gaussLegendre(13);
  for (const side of [1, -1])
    for (let h = 0; h < 13; ++h)
      for (let a = 0; a < 29; ++a) {
        const y = side * 0.5 * (nodes[h] + 1);
        const [phi, radius] = [(2 * Math.PI * (a + 0.3)) / 29, Math.sqrt(1 - y * y)];
        take([radius * Math.cos(phi), y, radius * Math.sin(phi)], (0.5 * weights[h] * 2 * Math.PI) / 29);
      }
}

/** Radiance of coefficients [order²][3] from a direction. */
function radiance(order, coefficients, direction) {
  const basis = evaluateSh(order, ...direction);
  return [0, 1, 2].map((c) => basis.reduce((sum, value, i) => sum + value * coefficients[3 * i + c], 0));
}

/** √(4π) Y of three bands, written out. */
const HARMONICS = [
  () => 1,
  ([, y]) => -Math.sqrt(3) * y,
  ([, , z]) => Math.sqrt(3) * z,
  ([x]) => -Math.sqrt(3) * x,
  ([x, y]) => Math.sqrt(15) * x * y,
  ([, y, z]) => -Math.sqrt(15) * y * z,
  ([, , z]) => (Math.sqrt(5) / 2) * (3 * z * z - 1),
  ([x, , z]) => -Math.sqrt(15) * x * z,
  ([x, y]) => (Math.sqrt(15) / 2) * (x * x - y * y),
];
/** Functions of a direction by which the light of a mode is multiplied. */
const PASSED = [...HARMONICS.map((harmonic) => (direction) => harmonic(direction) * Number(direction[1] > 0)), ([, y]) => Number(y < 0)];
const THROWN = HARMONICS.slice(0, 4);

/**
 * Returns the light of each mode in the space of an instance, rotated to world space by `rotation` (Matrix3):
 * coefficients [order²][3] for the sky, and for sky and suns.
 */
function modesInFrame(order, sky, suns, rotation) {
  const both = suns ? sky.map((value, i) => value + suns[i]) : sky;
  const modes = Array.from({ length: 14 }, () => [0, 1].map(() => new Float64Array(3 * order * order)));
  const level = [0, 0, 0];
  overHalves((direction, weight) => {
    if (direction[1] > 0) radiance(order, both, direction).forEach((value, c) => (level[c] += (weight * direction[1] * value) / Math.PI));
  });
  const back = rotation.clone().transpose();
  overHalves((direction, weight) => {
    const basis = evaluateSh(order, ...new Vector3(...direction).applyMatrix3(back).toArray());
    const lights = [sky, both].map((light) => radiance(order, light, direction));
    const add = (mode, light, factor) =>
      basis.forEach((value, i) => light.forEach((rgb, c) => (mode[3 * i + c] += weight * factor * value * rgb)));
    PASSED.forEach((passed, m) => lights.forEach((light, k) => add(modes[m][k], light, passed(direction))));
    THROWN.forEach((thrown, m) => [0, 1].forEach((k) => add(modes[10 + m][k], level, thrown(direction))));
  });
  return modes;
}

test("modes are products with functions of direction; level ground receives a clamped cosine", () => {
  for (const order of [1, 2, 3, 5, 8]) {
    const sky = lightOf(order, 3).coefficients();
    const modes = new InstanceModes(order);
    const expected = modesInFrame(order, sky, null, new Matrix3());
    modes.passing(sky).forEach((light, m) => light.forEach((value, i) => near(value, expected[m][0][i], 1e-9, `mode ${m}`)));
    const level = modes.onLevel(sky);
    // Mode 10 is a sky of that everywhere.
    level.forEach((value, c) => near(value * Math.sqrt(4 * Math.PI), expected[10][0][c], 1e-9));
  }
  const white = new Float64Array(3 * 9);
  white.fill(Math.sqrt(4 * Math.PI), 0, 3);
  new InstanceModes(3).onLevel(white).forEach((value) => near(value, 1, 1e-12));
  const modes = new InstanceModes(3).passing(white);
  const [above, below] = [modes[0], modes[9]];
  above.forEach((value, i) => near(value + below[i], white[i], 1e-12));
});

test("rotations about +Y fall into bins, others stay separate", () => {
  const rotation = (quaternion) => new Matrix3().setFromMatrix4(new Matrix4().makeRotationFromQuaternion(quaternion)).elements;
  const yaw = (angle) => rotation(new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), angle));
  const step = (2 * Math.PI) / 64;
  const leaning = rotation(new Quaternion(0.48, 0.36, 0, 0.8));
  const { rotations, of } = instanceRotations([yaw(0), yaw(0.4 * step), yaw(-0.4 * step), yaw(0.6 * step), leaning, yaw(2 * Math.PI - 0.1 * step), leaning], 64);
  assert.deepEqual([...of], [0, 0, 0, 1, 2, 0, 2]);
  [0, 1].forEach((steps, i) => rotations[i].forEach((value, e) => near(value, yaw(steps * step)[e], 1e-12)));
  assert.deepEqual(rotations[2], leaning);
  assert.equal(instanceRotations([yaw(0), yaw(0.4 * step)], 0).rotations.length, 2);
});

/**
 * Returns the shader's result for vertex `v` of instance `i` of a mesh: prt_instances.glsl and
 * prt_exit_radiance.glsl in plain JavaScript.
 */
function shaded(prtkit, mesh, i, v) {
  const { attributes } = mesh.geometry;
  const four = (attribute, n) => [0, 1, 2, 3].map((k) => attribute.getComponent(n, k));
  const [low, high] = [four(attributes.prt_instance_0, i), four(attributes.prt_instance_1, i)];
  const position = new Vector3().fromBufferAttribute(attributes.position, v).toArray();
  const normal = new Vector3().fromBufferAttribute(attributes.normal, v).normalize().toArray();
  const point = [...position.map((x, a) => (x - low[a]) * high[a]), 1];
  const first = (low[3] + high[3] * 65536) >>> 0;
  const { uniforms, defines } = prtkit.instances.transferOf(mesh);
  const { data } = uniforms.prt_constants.value.image;
  const constant = (row) => {
    const at = 3 * ((first + row) >>> 0);
    return [0, 1, 2].map((c) => point.reduce((sum, x, k) => sum + x * data[4 * (at + c) + k], 0));
  };
  const word = (n) => attributes.prt_words_0.getComponent(v, n);
  const bits = defines.PRT_PACKED_WORDS ? (BigInt(word(1)) << 32n) | BigInt(word(0)) : 0n;
  const cluster = defines.PRT_PACKED_WORDS ? Number(bits & 15n) : attributes.prt_cluster.getX(v);
  const table = uniforms.prt_clusters.value.image.data.subarray(4 * cluster, 4 * cluster + 4);
  const sum = constant(table[0]);
  let row = table[0] + 1;
  const add = (factor) => constant(row++).forEach((value, c) => (sum[c] += factor * value));
  if (defines.PRT_PREDICTOR_NORMAL) normal.forEach(add);
  if (defines.PRT_PREDICTOR_POSITION) {
    const origin = defines.PRT_PREDICTOR_ORIGIN.match(/[-\d.]+(?=[,)])/g).map(Number);
    position.forEach((x, a) => add(x - origin[a]));
  }
  let at = 4n;
  for (let j = 0; j < table[1]; ++j) {
    const width = ((table[2] >> (4 * j)) & 15) + 1;
    if (!defines.PRT_PACKED_WORDS) add(attributes.prt_weights_0.getComponent(v, j));
    else add(Number((bits >> at) & ((1n << BigInt(width)) - 1n)));
    at += BigInt(width);
  }
  return sum;
}

/**
 * Returns the expected result from the transfer of the vertex and the lights of the modes: docs/format.md,
 * PRTKIT_instances.
 */
function expectedOf(prtkit, mesh, v, modes, numbers, box, lampOf = () => 0) {
  const { clusters } = prtkit;
  const { order, predictors, components, firstRows, rows, widths } = clusters;
  const { attributes } = mesh.geometry;
  const size = rows.length / clusters.rowCount;
  const position = new Vector3().fromBufferAttribute(attributes.position, v).toArray();
  const normal = new Vector3().fromBufferAttribute(attributes.normal, v).normalize().toArray();
  const packed = attributes.prt_words_0;
  const bits = packed ? (BigInt(packed.getComponent(v, 1)) << 32n) | BigInt(packed.getComponent(v, 0)) : 0n;
  const cluster = packed ? Number(bits & 15n) : attributes.prt_cluster.getX(v);
  const row = (r) => rows.subarray((firstRows[cluster] + r) * size, (firstRows[cluster] + r + 1) * size);
  const vector = Float64Array.from(row(0));
  const add = (r, factor) => row(r).forEach((value, a) => (vector[a] += factor * value));
  predictors.forEach(({ kind, scale, origin }, g) =>
    scale.forEach((s, a) => add(1 + 3 * g + a, s * (kind === "normal" ? normal[a] : position[a] - origin[a]))));
  let at = 4n;
  for (let j = 0; j < components[cluster]; ++j) {
    let weight = packed ? 0 : attributes.prt_weights_0.getComponent(v, j);
    if (packed) {
      const most = 2 ** widths[cluster][j] - 1;
      weight = (2 * Number((bits >> at) & BigInt(most)) - most) / most;
      at += BigInt(widths[cluster][j]);
    }
    add(1 + 3 * predictors.length + j, weight);
  }
  const point = [...position.map((x, a) => (x - box.middle[a]) / box.half[a]), 1];
  const count = order * order;
  const result = [0, 0, 0];
  modes.forEach(([sky, both], m) => {
    for (let c = 0; c < 3; ++c) {
      const factor = m < 10 ? point.reduce((sum, x, k) => sum + x * numbers[4 * m + k], 0) : numbers[40 + 3 * (m - 10) + c];
      for (let i = 0; i < count; ++i)
        result[c] += factor * (vector[i] * sky[3 * i + c] + vector[count * (1 + c) + i] * both[3 * i + c]);
    }
  });
  for (let i = 0; i < count; ++i)
    for (let c = 0; c < 3; ++c)
      for (let k = 0; k < 4; ++k)
        result[c] += Math.sqrt(4 * Math.PI) * (vector[i] + vector[count * (1 + c) + i]) * point[k] * lampOf(c, 12 * i + 4 * c + k);
  return result;
}

for (const [by, lamps] of [["vertices", []], ["weights", []], ["vertices", LAMPS]])
  test(`instances are lit as docs/format.md defines: ${by}, ${lamps.length} lamps`, async () => {
    const { scene, userData } = await load(instanceModel(by, undefined, lamps));
    const strengths = { Lantern: [0.5, 2, 1], Fire: 3 };
    const lampOf = (number) => (c, j) =>
      lamps.reduce((sum, name, l) => sum + (strengths[name][c] ?? strengths[name]) * lampNumber(number, l, j), 0);
    const { prtkit } = userData;
    const { meshes } = prtkit.instances;
    assert.deepEqual(meshes.map(({ count }) => count), [4, 2]);
    const [sky, suns] = [lightOf(2, 3), lightOf(2, 5)];
    const numbers = factors();
    for (const separate of [null, suns]) {
      prtkit.setLight(sky, 0.3, separate, lamps.length > 0 ? strengths : {});
      const lights = [sky.coefficients(0.3), separate?.coefficients(0.3) ?? null];
      let number = 0;
      for (const [m, mesh] of meshes.entries())
        for (let i = 0; i < mesh.count; ++i, ++number) {
          const matrix = new Matrix4();
          mesh.getMatrixAt(i, matrix);
          const axes = new Matrix4().extractRotation(matrix.premultiply(scene.matrixWorld));
          const modes = modesInFrame(2, ...lights, new Matrix3().setFromMatrix4(axes));
          const rotated = number === 2; // between bins of yaw: by 0.8 degrees
          for (let v = 0; v < mesh.geometry.attributes.position.count; v += 97) {
            const own = numbers.slice(52 * number, 52 * (number + 1));
            const [value, expected] = [shaded(prtkit, mesh, i, v), expectedOf(prtkit, mesh, v, modes, own, BOXES[m], lampOf(number))];
            expected.forEach((x, c) => near(value[c], x, rotated ? 0.03 : 1e-5, `instance ${number}, vertex ${v}`));
          }
        }
      assert.equal(number, COUNT);
    }
  });

test("an unoccluded instance has the light of its mesh", async () => {
  const { userData } = await load(instanceModel("vertices", (json, binary) => {
    json.extensions.PRTKIT_instances.factors.bufferView = binary.view(new Int8Array(52 * COUNT));
  }));
  const { prtkit } = userData;
  prtkit.setLight(lightOf(2, 3), 0.3);
  const constants = prtkit.constantsTexture.image.data; // constants without rotation
  const { instances: { constantsTexture, relighter } } = prtkit;
  const { rows } = relighter.instances[0];
  for (let row = 0; row < rows.length; ++row)
    for (let c = 0; c < 3; ++c) {
      const at = 4 * (3 * row + c);
      near(constantsTexture.image.data[at + 3], constants[4 * rows[row] + c], 1e-5);
      assert.ok([0, 1, 2].every((k) => Math.abs(constantsTexture.image.data[at + k]) < 1e-6));
    }
});

test("each primitive is drawn once, at the positions of its nodes", async () => {
  const { scene, userData, parser } = await load(instanceModel());
  const drawn = [];
  scene.traverse((object) => object.isMesh && drawn.push(object));
  assert.deepEqual(drawn.map(({ isInstancedMesh = false }) => isInstancedMesh), [false, true, true]);
  const { instances } = userData.prtkit;
  assert.deepEqual(drawn.slice(1), instances.meshes);
  assert.deepEqual([instances.count, instances.bytesPerInstance], [COUNT, 52]);
  assert.ok(instances.constantsBytesPerInstance > 0 && instances.constantsBytesPerInstance % 48 === 0);
  const points = instances.meshes.flatMap((mesh) =>
    Array.from({ length: mesh.count }, (_, i) => {
      const matrix = new Matrix4();
      mesh.getMatrixAt(i, matrix);
      return new Vector3().setFromMatrixPosition(matrix);
    }));
  for (let i = 0; i < 4; ++i) assert.ok(points[i].distanceTo(new Vector3(...PLACES.TRANSLATION.slice(3 * i))) < 1e-6);
  // The hill rotates +X to -Z, and +Z to +X.
  assert.ok(points[4].distanceTo(new Vector3(0.5, 0.1, -0.8)) < 1e-6, points[4].toArray());
  assert.ok(points[5].distanceTo(new Vector3(1.5, 0.1, 0.5)) < 1e-6, points[5].toArray());
  // Culled by all of them together.
  const [balls] = instances.meshes;
  balls.computeBoundingSphere();
  const box = new Box3().setFromObject(balls);
  assert.ok(box.min.x < -1.5 - 0.25 && box.max.x > 1.2 && balls.boundingSphere.radius > 1.5);
  // three's data equal the content of the file.
  assert.equal(parser.json.nodes[1].mesh, 1);
  assert.ok(parser.json.nodes[1].extensions.EXT_mesh_gpu_instancing.attributes.TRANSLATION >= 0);
  for (const mesh of instances.meshes) assert.ok(mesh.castShadow && mesh.receiveShadow && mesh.material.defines.PRT_SUNS);
});

test("animated instances are drawn in their node", async () => {
  const { scene, userData } = await load(instanceModel("vertices", (json, binary) => {
    const sampler = { input: binary.accessor(new Float32Array([0, 1]), "SCALAR", { min: [0], max: [1] }), output: binary.accessor(new Float32Array(6), "VEC3") };
    json.animations = [{ samplers: [sampler], channels: [{ sampler: 0, target: { node: 3, path: "translation" } }] }];
  }));
  const { meshes } = userData.prtkit.instances;
  assert.deepEqual(meshes.map(({ count }) => count), [4, 1, 1]);
  const moving = meshes.find(({ parent }) => parent !== scene);
  assert.ok(moving.getWorldPosition(new Vector3()).distanceTo(new Vector3(0.5, 0.1, -0.8)) < 1e-6);
  const [one, other] = meshes.slice(1).map(({ geometry }) => geometry);
  assert.ok(one !== other && one.attributes.position === other.attributes.position && one.attributes.prt_instance_0 !== other.attributes.prt_instance_0);
});

test("changed light is computed again, also after rotation of the model", async () => {
  const { scene, userData } = await load(instanceModel());
  const { prtkit } = userData;
  const texture = prtkit.instances.constantsTexture;
  const shown = { environment: null, backgroundRotation: { x: 0, y: 0, z: 0, order: "XYZ" }, backgroundIntensity: 1 };
  const light = lightOf(2, 3);
  prtkit.setLight(light, 0.4);
  const rotated = texture.image.data.slice();
  const { version } = texture;
  prtkit.setSky(light, shown);
  assert.ok(texture.version > version && rotated.some((value, i) => Math.abs(value - texture.image.data[i]) > 1e-3));
  scene.rotation.y = -0.4; // rotates the light by the same angle
  scene.updateMatrixWorld(true);
  prtkit.followSky();
  rotated.forEach((value, i) => near(texture.image.data[i], value, 1e-5));
  shown.backgroundIntensity = 2;
  prtkit.followSky();
  rotated.forEach((value, i) => near(texture.image.data[i], 2 * value, 1e-5));
});

test("only instances use the runtime's shader for instances", async () => {
  const { scene, userData } = await load(instanceModel("weights"));
  const compiled = ({ material }) => {
    const shader = { uniforms: {}, vertexShader: ShaderLib.physical.vertexShader, fragmentShader: ShaderLib.physical.fragmentShader };
    material.onBeforeCompile(shader);
    return shader;
  };
  const [mesh] = userData.prtkit.instances.meshes;
  const { vertexShader, uniforms } = compiled(mesh);
  assert.match(vertexShader, /vec3 prt_instance_radiance\(vec4 instance_0, vec4 instance_1, vec3 position, vec3 normal\)/);
  assert.match(vertexShader, /prtRadiance = prt_instance_radiance\(prt_instance_0, prt_instance_1, prtBakedPosition\(\), prtBakedNormal\(\)\);/);
  assert.equal(vertexShader.match(/vec3 prt_exit_radiance\(/g).length, 3); // once for each layout of weights
  assert.equal(uniforms.prt_constants.value, userData.prtkit.instances.constantsTexture);
  assert.equal(mesh.material.defines.PRT_PREDICTOR_ORIGIN, `vec3(${[0.1, 0.2, -0.1].map(Math.fround).join(", ")})`);
  const floor = scene.children.find(({ isMesh, isInstancedMesh }) => isMesh && !isInstancedMesh);
  assert.doesNotMatch(compiled(floor).vertexShader, /vec3 prt_instance_radiance/);
  assert.equal(compiled(floor).uniforms.prt_constants.value, userData.prtkit.constantsTexture);
});

test("tables are freed, and textures too large for the device are rejected", async () => {
  const { prtkit } = (await load(instanceModel())).userData;
  const freed = [];
  const { constantsTexture, clustersTextures } = prtkit.instances;
  for (const texture of [constantsTexture, ...clustersTextures]) texture.addEventListener("dispose", () => freed.push(texture));
  assert.throws(() => prtkit.instances.checkSize({ capabilities: { maxTextureSize: 64 } }), /constants of 6 instances need a texture of 256 x/);
  prtkit.instances.checkSize({ capabilities: { maxTextureSize: 4096 } });
  prtkit.dispose();
  assert.deepEqual(freed, [constantsTexture, ...clustersTextures]);
});

test("WebGPURenderer is rejected", async () => {
  await assert.rejects(load(instanceModel(), NodePlugin), /^Error: PRTKIT_instances: WebGPURenderer is not supported; use WebGLRenderer/);
});

const extensionOf = (json) => json.extensions.PRTKIT_instances;
const nodeOf = (json, n = 1) => json.nodes[n].extensions.PRTKIT_instances;
const gpuOf = (json) => json.nodes[1].extensions.EXT_mesh_gpu_instancing.attributes;

for (const [what, change, message] of [
  ["another version", (json) => (extensionOf(json).version = 1), /version 1 is not supported, only 3/],
  ["not an object", (json) => (json.extensions.PRTKIT_instances = []), /is not an object/],
  ["a count of zero", (json) => (extensionOf(json).count = 0), /the count is not 1 to/],
  ["a count that is too large", (json) => (extensionOf(json).count = 1e7), /the count is not 1 to/],
  ["fewer factors", (json) => (extensionOf(json).count = 7), /the factors do not have the size of 7/],
  ["no factors", (json) => delete extensionOf(json).factors, /factors are missing/],
  ["a missing view", (json) => (extensionOf(json).factors.bufferView = 999), /buffer view 999 cannot be read/],
  ["factors of floats", (json, binary) => (extensionOf(json).factors.bufferView = binary.view(Float32Array.from(bytes()))), /the factors do not have the size of 6/],
  ["no scales", (json) => delete extensionOf(json).factors.scales, /the scales of the factors are not 52 numbers from 0 to 500/],
  ["fewer scales", (json) => (extensionOf(json).factors.scales = SCALES.slice(1)), /the scales of the factors are not 52/],
  ["a scale below zero", (json) => (extensionOf(json).factors.scales = SCALES.with(7, -0.01)), /the scales of the factors are not 52/],
  ["a scale that is too large", (json) => (extensionOf(json).factors.scales = SCALES.with(51, 501)), /the scales of the factors are not 52/],
  ["a scale that is not finite", (json) => (extensionOf(json).factors.scales = SCALES.with(0, NaN)), /the scales of the factors are not 52/],
  ["a scale that is not a number", (json) => (extensionOf(json).factors.scales = SCALES.with(0, "1")), /the scales of the factors are not 52/],
  ["no boxes", (json) => (extensionOf(json).boxes = []), /boxes are missing/],
  ["a flat box", (json) => (extensionOf(json).boxes = [{ middle: [0, 0, 0], half: [1, 0, 1] }]), /a box is invalid/],
  ["an invalid box", (json) => (extensionOf(json).boxes = [null]), /a box is invalid/],
  ["a missing instance", (json) => (nodeOf(json, 4).first = 6), /node 4 names an instance or a box that does not exist/],
  ["a missing box", (json) => (nodeOf(json).box = 2), /node 1 names an instance or a box/],
  ["an invalid node", (json) => (json.nodes[1].extensions.PRTKIT_instances = 3), /node 1 names an instance or a box/],
  ["more instances than factors", (json) => (nodeOf(json).first = 3), /node 1 has no instances, or more/],
  ["instances of several nodes", (json) => {
    json.nodes.push({ mesh: 1, extensions: structuredClone(json.nodes[1].extensions) });
    json.scenes[0].nodes.push(5);
  }, /there are more instances than factors/],
  ["no mesh", (json) => delete json.nodes[1].mesh, /node 1 has no mesh/],
  ["a missing mesh", (json) => (json.nodes[1].mesh = 77), /node 1 has no mesh/],
  ["a mesh that other nodes draw", (json) => {
    json.nodes.push({ mesh: 1 });
    json.scenes[0].nodes.push(5);
  }, /node 5 uses a mesh with shared transfer, but is not an instance/],
  ["a skin", (json) => (json.nodes[1].skin = 0), /node 1 has a skin/],
  ["a mirror", (json) => (json.nodes[3].scale = [-1, 1, 1]), /node 3 mirrors an instance/],
  ["an uneven scale", (json) => (json.nodes[2].scale = [1, 2, 1]), /node 3 mirrors an instance or scales it non-uniformly/],
  ["a scale of zero", (json, binary) => (gpuOf(json).SCALE = binary.accessor(new Float32Array(12), "VEC3")), /node 1 mirrors an instance/],
  ["attributes of different lengths", (json, binary) => (gpuOf(json).SCALE = binary.accessor(new Float32Array(6).fill(1), "VEC3")), /have different lengths/],
  ["no attributes", (json) => (json.nodes[1].extensions.EXT_mesh_gpu_instancing.attributes = {}), /attributes of node 1 are missing/],
  ["attributes of another type", (json, binary) => (gpuOf(json).ROTATION = binary.accessor(new Float32Array(12), "VEC3")), /ROTATION of node 1 is not a vector of 4/],
  ["a missing accessor", (json) => (gpuOf(json).SCALE = 999), /node 1 has no instances, or more/],
  ["too many instances", (json) => (json.accessors = undefined, gpuOf(json).SCALE = -1), /node 1 has no instances, or more/],
  ["a lamp", (json) => {
    setIn(json, "vertices").terms = [{ kind: "indirect", channels: 3 }, ...[0, 1, 2, 3].map((i) => ({ kind: "lamp", channels: 1, name: `lamp ${i}` }))];
  }, /have the light of 0 lamps, the transfer has 4/],
  ["fewer lamps", (json, binary) => (json.extensions.PRTKIT_instances.lamps = { count: 1, bufferView: binary.view(lampBytes()) }), /have the light of 1 lamps, the transfer has 0/],
  ["lamps without a view", (json) => (json.extensions.PRTKIT_instances.lamps = { count: 1 }), /the lamps are invalid/],
  ["texels", (json, binary) => {
    json.images = [];
    addSet(json, texelSet(json, binary));
  }, /the file also has transfer of texels/],
])
  test(`${what}: rejected with a reason`, async () => {
    await assert.rejects(load(instanceModel("vertices", change)), (error) => {
      assert.match(error.message, /^PRTKIT_instances: /);
      assert.match(error.message, message);
      return true;
    });
  });
