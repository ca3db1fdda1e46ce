// Files with transfer of probes: tests of reading, computing, textures and materials against plain arithmetic. renderers.mjs draws them.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  BoxGeometry,
  Group,
  InstancedMesh,
  Mesh,
  MeshBasicMaterial,
  MeshPhongMaterial,
  MeshPhysicalMaterial,
  MeshStandardMaterial,
  ShaderLib,
} from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { lightColumns } from "../src/clusteredPca.js";
import { halfFloat, halvesOf } from "../src/halfFloat.js";
import { lightOfSuns, PrtkitPlugin, PrtkitVolume, ShLight } from "../src/PrtkitLoader.js";
import { evaluateSh } from "../src/sphericalHarmonics.js";
import { positionOf } from "../src/volumeGrid.js";
import { atlasOf, texelOf } from "../src/volumeTextures.js";
import { volumeOf } from "../src/volumeTransfer.js";
import { bakedModel } from "./bakedModel.js";
import { setOf } from "./glb.js";
import { BOXES, occluderModel } from "./occluderModel.js";
import { addSet, setIn } from "./transferSets.js";
import { GRID, incidentAt, PROBES, volumeModel, volumeSet } from "./volumeModel.js";

const load = (file) => {
  const loader = new GLTFLoader().register((parser) => new PrtkitPlugin(parser));
  return loader.parseAsync(file.buffer.slice(file.byteOffset, file.byteOffset + file.length), "");
};
const readVolume = (options, change) => {
  const { set, view } = setOf(volumeModel(options, change), "probes");
  return volumeOf(set, view);
};
const coefficients = Array.from({ length: 27 }, (_, i) => Math.cos(3 * i + 1) + (i < 3 ? 3 : 0));
const light = ShLight.fromCoefficients(3, coefficients);

/** Returns the four numbers of a plane at the first texel of a probe. */
function numbersAt(volume, probe) {
  const { atlas, source: { grid }, texture } = volume;
  const e = grid.ofBrick.indexOf(probe);
  const texel = texelOf(atlas, Math.floor(e / 125), e % 125);
  const values = Array.from({ length: 4 * atlas.planes }, (_, n) => texture.image.data[4 * ((n >> 2) * atlas.texels + texel) + (n & 3)]);
  return texture.image.data instanceof Uint16Array ? values.map(halfFloat) : values;
}

test("half floats are rounded to nearest", () => {
  const bits = Array.from({ length: 0x7c00 }, (_, i) => i);
  const exact = bits.map(halfFloat);
  assert.deepEqual([...halvesOf(exact, new Uint16Array(bits.length))], bits);
  assert.deepEqual([...halvesOf(exact.map((x) => -x), new Uint16Array(bits.length))], bits.map((b) => b | 0x8000).map((b) => (b === 0x8000 ? halvesOf([-0], [0])[0] : b)));
  const between = bits.slice(1).map((b) => (exact[b] + exact[b - 1]) / 2); // the even one of both
  assert.deepEqual([...halvesOf(between, new Uint16Array(between.length))], bits.slice(1).map((b) => (b % 2 === 0 ? b : b - 1)));
  assert.deepEqual([...halvesOf([1e9, -Infinity], new Uint16Array(2))], [0x7bff, 0xfbff]);
});

test("probes are the corners of all bricks in order, shared corners once", () => {
  const { grid } = readVolume();
  assert.equal(grid.levels.length, PROBES);
  const seen = new Map();
  grid.ofBrick.forEach((probe, e) => {
    const [b, i] = [Math.floor(e / 125), e % 125];
    const width = [2, 1][b];
    const first = [[0, 0, 0], [8, 0, 0]][b];
    const corner = [i % 5, Math.floor(i / 5) % 5, Math.floor(i / 25)].map((step, a) => first[a] + width * step);
    if (!seen.has(corner.join())) seen.set(corner.join(), seen.size);
    assert.equal(probe, seen.get(corner.join()));
    assert.deepEqual([...grid.corners.subarray(3 * probe, 3 * probe + 3)], corner);
    assert.deepEqual(positionOf(grid, probe), corner.map((n, a) => GRID.origin[a] + GRID.spacing * n));
    assert.equal(grid.levels[probe], corner[0] <= 8 ? (corner.every((n) => n % 2 === 0) ? 1 : 0) : 0);
  });
});

test("incident light at probes follows the words for every term, in half floats and floats", () => {
  for (const incidentOrder of [2, 3, 4])
    for (const floats of [false, true]) {
      const volume = readVolume({ incidentOrder });
      const shown = new PrtkitVolume(volume, new Group(), new PrtkitPlugin(), { floats });
      const suns = lightOfSuns([{ towards: [0.6, 0.64, -0.48], irradiance: [3, 2, 1], halfAngle: 0 }], 3);
      shown.setLight(light, 0.4, suns, { Lantern: [0.5, 2, 0.25] });
      shown.settle();
      const columns = lightColumns(volume.clusters, light.coefficients(0.4), suns.coefficients(0.4), [0.5, 2, 0.25]);
      for (let probe = 0; probe < PROBES; ++probe) {
        const numbers = numbersAt(shown, probe);
        incidentAt(volume, probe, columns).flat().forEach((expected, n) => {
          const most = floats ? 1e-5 * Math.max(1, Math.abs(expected)) : 2 ** -11 * Math.abs(expected) + 1e-5;
          assert.ok(Math.abs(numbers[n] - expected) <= most, `order ${incidentOrder}, probe ${probe}, ${n}: ${numbers[n]}, not ${expected}`);
        });
      }
    }
});

test("an unoccluded probe has the unchanged light and sees the sun", () => {
  const volume = new PrtkitVolume(readVolume({ open: true }), new Group(), new PrtkitPlugin(), { floats: true });
  const towards = [0.48, 0.8, 0.36];
  volume.setLight(light, 0, lightOfSuns([{ towards, irradiance: [5, 4, 3], halfAngle: 0 }], 3));
  volume.settle();
  // Transfer of the probe is the identity for nine coefficients, so it receives Y_0 · Y_0 of a direction.
  for (const probe of [0, 17, PROBES - 1]) {
    const numbers = numbersAt(volume, probe);
    light.coefficients().forEach((expected, n) => assert.ok(Math.abs(numbers[n] - expected) < 1e-6));
    assert.ok(Math.abs(numbers[27] - 1) < 1e-6, `${numbers[27]} of the sun`);
  }
  assert.equal(volume.uniforms.prtSeparateSuns.value, true);
  volume.setLight(light);
  volume.settle();
  assert.equal(numbersAt(volume, 3)[27], 0);
  assert.equal(volume.uniforms.prtSeparateSuns.value, false);
});

test("sun visibility of probes is their direct transfer towards it", () => {
  const volume = readVolume();
  const shown = new PrtkitVolume(volume, new Group(), new PrtkitPlugin(), { floats: true });
  const towards = [-0.6, 0.48, 0.64];
  shown.setLight(light, 0, lightOfSuns([{ towards, irradiance: [5, 5, 5], halfAngle: 0 }], 3));
  shown.settle();
  const basis = evaluateSh(3, ...towards);
  const one = lightColumns(volume.clusters, new Float64Array(27).map((_, i) => basis[Math.floor(i / 3)]), null, [0, 0, 0]);
  one.fill(0, 27); // direct light only
  for (let probe = 0; probe < PROBES; ++probe) {
    const expected = Math.min(Math.max(incidentAt(volume, probe, one)[0][0] / basis[0], 0), 1);
    assert.ok(Math.abs(numbersAt(shown, probe)[27] - expected) < 1e-5);
  }
});

test("a change of light takes several frames, which show the previous light", () => {
  const volume = new PrtkitVolume(readVolume(), new Group(), new PrtkitPlugin());
  const renderer = { info: { render: { frame: 0 } } };
  const draw = () => (++renderer.info.render.frame, volume.beforeRender(renderer));
  volume.setLight(light);
  draw(); // the first frame is complete
  assert.ok(volume.isSettled);
  const before = numbersAt(volume, 5);
  volume.setLight(light.times(2));
  draw();
  assert.ok(!volume.isSettled);
  assert.deepEqual(numbersAt(volume, 5), before);
  volume.beforeRender(renderer); // in the same frame
  for (let i = 0; i < 3 && !volume.isSettled; ++i) draw();
  assert.ok(volume.isSettled);
  assert.notDeepEqual(numbersAt(volume, 5), before);
});

test("devices with textures that are too small are rejected", () => {
  const volume = new PrtkitVolume(readVolume(), new Group(), new PrtkitPlugin());
  const gl = { MAX_3D_TEXTURE_SIZE: 7, getParameter: (name) => (name === 7 ? 32 : 0) };
  volume.setLight(light);
  const renderer = { info: { render: { frame: 1 } }, getContext: () => gl };
  assert.throws(() => volume.beforeRender(renderer), /the volume needs a texture with a side of 35 texels; this device supports at most 32/);
});

test("a volume and transfer of surfaces are lit together", async () => {
  const { userData } = await load(bakedModel("vertices", (json, binary) => {
    delete json.textures;
    json.materials = json.materials.map(({ normalTexture: _, ...material }) => material);
    addSet(json, volumeSet(binary));
  }));
  const { prtkit } = userData;
  assert.ok(prtkit.volume instanceof PrtkitVolume);
  assert.deepEqual([prtkit.volume.probes, prtkit.volume.incidentOrder, prtkit.volume.bytesPerProbe], [PROBES, 3, 14]);
  prtkit.setLight(light, 0.2, null, { Lantern: 0.5 });
  assert.deepEqual(prtkit.volume.strengths.get("Lantern").value.toArray(), [0.5, 0.5, 0.5]);
  // The model has order two, the volume three: an error of one leaves both unchanged.
  const before = prtkit.constantsTexture.version;
  assert.throws(() => prtkit.setLight(ShLight.fromCoefficients(2, coefficients.slice(0, 12))), /the light has order 2, the model needs 3/);
  assert.equal(prtkit.constantsTexture.version, before);
});

test("a file may contain only a volume", async () => {
  const { userData } = await load(volumeModel());
  assert.equal(userData.prtkit.volume, userData.prtkit);
  assert.deepEqual(userData.prtkit.lamps, ["Lantern"]);
});

test("materials of moving objects are copies that keep custom shaders, also after cloning", () => {
  const volume = new PrtkitVolume(readVolume(), new Group(), new PrtkitPlugin());
  const compiled = [];
  const source = new MeshStandardMaterial({ color: 0x336699 });
  source.onBeforeCompile = (shader) => compiled.push(shader);
  const coat = new MeshPhysicalMaterial({ clearcoat: 1, transmission: 0.5 });
  const unlit = new MeshBasicMaterial();
  const character = new Group().add(
    new Mesh(new BoxGeometry(), source),
    new InstancedMesh(new BoxGeometry(), [source, coat], 2),
    new Mesh(new BoxGeometry(), unlit),
  );
  assert.equal(volume.light(character), character);
  const [box, instances, other] = character.children;
  assert.equal(other.material, unlit);
  assert.notEqual(box.material, source);
  assert.ok(box.castShadow && box.receiveShadow && !other.receiveShadow);
  for (const material of [box.material, box.material.clone(), instances.material[0], instances.material[1].clone().clone()]) {
    assert.deepEqual(material.defines.PRT_VOLUME_ORDER, 3);
    const shader = { uniforms: {}, vertexShader: ShaderLib.physical.vertexShader, fragmentShader: ShaderLib.physical.fragmentShader };
    material.onBeforeCompile(shader, null);
    assert.match(shader.fragmentShader, /prt_volume_incident\( prtVolumePosition/);
    assert.match(shader.fragmentShader, /#include <aomap_fragment>/); // its own occlusion is kept
    assert.equal(shader.uniforms.prt_volume_light.value, volume.texture);
  }
  assert.equal(compiled.length, 3);
  assert.equal(source.defines?.PRT_VOLUME, undefined);
  const lit = box.material;
  volume.light(character);
  assert.equal(box.material, lit); // once is enough
  const second = new PrtkitVolume(readVolume(), new Group(), new PrtkitPlugin());
  second.light(character); // it has moved into the second volume
  assert.equal(box.material._transfer.model, second);
  assert.equal(box.material._transfer.source, source);
  assert.throws(() => volume.light(new Mesh(new BoxGeometry(), new MeshPhongMaterial())), /does not light MeshPhongMaterial/);
});

test("band factors of mirrored light match the GGX integral, and the cosine at roughness 1", async () => {
  const { default: text } = await import("../src/volumeLight.glsl.js");
  const less = text.match(/vec3 less = vec3\(([^)]*)\) \+ a \* vec3\(([^)]*)\)/).slice(1).map((list) => list.split(",").map(Number));
  const legendre = [(x) => x, (x) => (3 * x * x - 1) / 2, (x) => (5 * x ** 3 - 3 * x) / 2];
  for (let roughness = 0.05; roughness <= 1; roughness += 0.05) {
    const a = roughness ** 2;
    const sums = [0, 0, 0, 0];
    for (let i = 0; i < 2000; ++i) {
      const u = (i + 0.5) / 2000; // denser where the lobe is
      const angle = (Math.PI / 2) * u ** 3;
      const half = Math.cos(angle / 2) ** 2 * (a * a - 1) + 1;
      const weight = (Math.cos(angle) * Math.sin(angle) * u * u) / half ** 2;
      sums[3] += weight;
      legendre.forEach((p, l) => (sums[l] += weight * p(Math.cos(angle))));
    }
    [2 / 3, 1 / 4, 0].forEach((end, l) => {
      const kept = 1 + (end - 1) * a - a * (1 - a) * (less[0][l] + a * less[1][l]);
      assert.ok(Math.abs(kept - sums[l] / sums[3]) < 0.04, `roughness ${roughness}, band ${l + 1}: ${kept}, not ${sums[l] / sums[3]}`);
    });
  }
});

test("textures have the layout of docs and shader", () => {
  const bricks = (count) => ({ bricks: new Uint16Array(4 * count) });
  assert.deepEqual(atlasOf(bricks(1), 3).bricks, [1, 1, 1]);
  assert.deepEqual(atlasOf(bricks(52), 3).bricks, [26, 2, 1]);
  assert.deepEqual(atlasOf(bricks(2602), 2).bricks.map((n) => n <= 51), [true, true, true]);
  assert.deepEqual([2, 3, 4].map((order) => atlasOf(bricks(1), order).planes), [4, 7, 13]);
  const used = new Set();
  const atlas = atlasOf(bricks(60), 2);
  for (let b = 0; b < 60; ++b) for (let i = 0; i < 125; ++i) used.add(texelOf(atlas, b, i));
  assert.equal(used.size, 60 * 125);
  assert.ok(Math.max(...used) < atlas.texels);
});

const occluderIn = (json) => json.nodes[1].extensions.PRTKIT_occlusion_volume;
const wrongOccluders = {
  "another version": [(e) => (e.version = 2), /version 2 is not supported, only 1/],
  "a box with min above max": [(e) => ([e.min, e.max] = [e.max, e.min]), /the box is invalid/],
  "no reach": [(e) => delete e.reach, /the reach is not a number above 0/],
  "no texels": [(e) => delete e.texels, /texels are missing/],
  "short texels": [(e, binary) => (e.texels = { bufferView: binary.view(new Int8Array(7)) }), /node 1 has 7 bytes of texels, not 2048/],
};
for (const [what, [change, message]] of Object.entries(wrongOccluders))
  test(`occluders: ${what}: rejected with a reason`, async () => {
    await assert.rejects(load(occluderModel((json, binary) => change(occluderIn(json), binary))), (error) => {
      assert.match(error.message, /^PRTKIT_occlusion_volume: /);
      assert.match(error.message, message);
      return true;
    });
  });

test("occluders darken surfaces at their positions while they are visible", async () => {
  const { scene, userData } = await load(occluderModel());
  const { prtkitOccluders: occluders } = userData;
  scene.children[0].position.set(1, 2, 3);
  scene.updateMatrixWorld();
  occluders.update();
  assert.equal(occluders.count, 2);
  const [low, high] = [BOXES[0].min, BOXES[0].max];
  [0, 1, 2].forEach((a) => assert.ok(Math.abs(occluders.rows[a].w + [1, 2, 3][a] + (low[a] + high[a]) / 2) < 1e-9));
  assert.ok(Math.abs(occluders.rows[3].w - BOXES[0].reach) < 1e-12);
  for (let i = 0; i < 2; ++i) {
    const at = (a) => -occluders.rows[5 * i + a].w; // occluders without rotation
    const away = Math.hypot(at(0) - occluders.reach.x, at(1) - occluders.reach.y, at(2) - occluders.reach.z);
    assert.ok(away + occluders.rows[5 * i + 3].w <= occluders.reach.w + 1e-9);
  }
  scene.children[0].visible = false;
  occluders.update();
  assert.deepEqual([occluders.count, occluders.rows[4].x], [1, 1]);
});

const refusals = {
  "a raw bake": [(e) => (e.coding = "raw"), /the file is an uncompressed bake; compress it: prt compress/],
  "an order outside the range": [(e) => (e.incidentOrder = 5), /the order of incident light is not 2 to 4/],
  "no spacing": [(e) => (e.spacing = 0), /the spacing or the origin is invalid/],
  "an origin that is not a list": [(e) => (e.origin = 3), /the spacing or the origin is invalid/],
  "too many bricks along an axis": [(e) => (e.size = [1025, 1, 1]), /the size is not 1 to 1024 bricks/],
  "more than the memory limit": [(e) => (e.size = [1024, 1024, 1024]), /the volume would need 17180 MB/],
  "predictors": [(e) => Object.assign(e, { predictors: [{ kind: "normal", scale: [1, 1, 1] }], centers: { ...e.words, drops: [0, 0, 0] } }), /predictors are only for vertices/],
  "coded words": [(e) => (e.packing.words = { ...e.words, vertices: 1, frequencies: { byteLength: 0, drops: [] } }), /coded words are only for vertices/],
  "weights that are not packed": [(e) => delete e.packing, /the weights are not packed/],
  "no words": [(e) => delete e.words, /bricks, visibility or words are missing/],
  "bricks that are not groups of eight bytes": [(e, binary) => (e.bricks = { bufferView: binary.view(new Uint8Array(9)) }), /not groups of eight bytes/],
  "a brick outside the volume": [(e, binary) => (e.bricks = { bufferView: binary.view(Uint16Array.of(3, 0, 0, 0)) }), /a brick is outside the volume/],
  "a brick off its level": [(e, binary) => (e.bricks = { bufferView: binary.view(Uint16Array.of(1, 0, 0, 1)) }), /a brick is outside the volume/],
  "bricks that overlap": [(e, binary) => (e.bricks = { bufferView: binary.view(Uint16Array.of(0, 0, 0, 1, 1, 1, 1, 0)) }), /two bricks overlap/],
  "visibility for other probes": [(e, binary) => (e.visibility = { bufferView: binary.view(new Uint8Array(12)) }), /visibility has values for 2 probes, not 241/],
  "words for other probes": [(e, binary) => (e.words = { bufferView: binary.view(new Uint8Array(12)) }), /the words do not have the size of 241 probes/],
  "a probe with a missing cluster": [(e, binary) => (e.words = { bufferView: binary.view(new Uint32Array(2 * PROBES).fill(3)) }), /probe 0 names a cluster that does not exist/],
  "bases of one output": [(e, binary) => (e.bases.bufferView = binary.view(new Float32Array(11 * 39))), /the bases do not contain 3861 floats/],
  "a missing buffer view": [(e) => (e.words.bufferView = 99), /buffer view 99 cannot be read/],
};
for (const [what, [change, message]] of Object.entries(refusals))
  test(`${what}: rejected with a reason`, async () => {
    const file = volumeModel({}, (json, binary) => change(setIn(json, "probes"), binary));
    await assert.rejects(load(file), (error) => {
      assert.match(error.message, /^PRTKIT_transfer: probes: /);
      assert.match(error.message, message);
      return true;
    });
  });
