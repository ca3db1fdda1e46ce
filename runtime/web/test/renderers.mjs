// Draws synthetic models in headless Chromium: compares the plug-in's results on the device with plain
// JavaScript, and WebGPURenderer with WebGLRenderer.
//   node test/renderers.mjs [PATTERN of the names of checks, default all]      PICTURES=FOLDER keeps the
// compared pictures
// Needs a chromium (CHROMIUM, default /usr/bin/chromium). THREE names the folder of a different release of
// three than this project's.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { DataUtils, Euler, Matrix4, Quaternion, Vector3 } from "three";
import { createServer } from "vite";
import { clustersOf, lightColumns } from "../src/clusteredPca.js";
import { volumeOf } from "../src/volumeTransfer.js";
import { bakedModel, MAPS, texelWords } from "./bakedModel.js";
import { png, setOf } from "./glb.js";
import { leftAt, occluderModel } from "./occluderModel.js";
import { boneMatrices, cornersOf, lobeModel, radianceOf, squares } from "./lobeModel.js";
import { addSet } from "./transferSets.js";
import { incidentAround, sumOf, volumeModel, volumeSet } from "./volumeModel.js";
import { radianceOfWords } from "./wordRadiance.js";

const [, , pattern = ""] = process.argv;
const web = fileURLToPath(new URL("../", import.meta.url));
const three = process.env.THREE ?? join(web, "node_modules/three");
const revision = Number.parseInt(JSON.parse(readFileSync(join(three, "package.json"), "utf8")).version.split(".")[1]);
const alias = [
  [/^three$/, "build/three.module.js"],
  [/^three\/(webgpu|tsl)$/, "build/three.$1.js"],
  [/^three\/examples/, "examples"],
].map(([find, file]) => ({ find, replacement: join(three, file) }));
const server = await createServer({
  root: web,
  server: { port: 0, host: "127.0.0.1", fs: { strict: false } },
  resolve: { alias },
  cacheDir: mkdtempSync(join(tmpdir(), "prtkit-vite-")),
  logLevel: "error",
});
process.on("exit", () => rmSync(server.config.cacheDir, { recursive: true, force: true }));
await server.listen();
const errors = [];
// The last but one is a warning of three about its clones, since release 187.
const UNHEARD = /GPU stall|WebGPU is not available|iridescenceThicknessRange|does not light baked meshes/;
/** A floor that light passes, and a ball that is unlit. */
function leafy(json) {
  json.materials = structuredClone(json.materials);
  json.materials[0].extensions = { KHR_materials_diffuse_transmission: { diffuseTransmissionFactor: 0.4, diffuseTransmissionColorFactor: [0.5, 1, 0.4] } };
  json.materials[0].doubleSided = true;
  json.materials[1].extensions = { KHR_materials_unlit: {} };
}
const models = Object.fromEntries(["vertices", "weights", "texels"].map((by) => [`${by}.glb`, bakedModel(by)]));
for (const by of ["vertices", "texels"])
  models[`moving_${by}.glb`] = bakedModel(by, (json, binary) => addSet(json, volumeSet(binary)));
models["volume.glb"] = volumeModel();
models["passer.glb"] = occluderModel();
for (const order of [2, 3, 4]) models[`lobes_${order}.glb`] = lobeModel(order);
for (const by of ["vertices", "texels"]) models[`leaf_${by}.glb`] = bakedModel(by, leafy);

/** Opens a page in a separate browser: a crash of software WebGPU takes the process of all pages with it. */
async function opened(...options) {
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking",
      "--disable-component-update", "--disable-sync", "--no-first-run", ...options],
  });
  const page = await browser.newPage({ viewport: { width: 320, height: 240 } });
  page.setDefaultTimeout(120_000); // a busy machine must not fail the test
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("console", (line) => ["error", "warning"].includes(line.type()) && !UNHEARD.test(line.text()) && errors.push(line.text()));
  await page.route("**/*.glb", (route) => route.fulfill({ body: models[new URL(route.request().url()).pathname.split("/").pop()] }));
  await page.goto(`http://127.0.0.1:${server.httpServer.address().port}/test/pictures/`);
  await page.waitForFunction(() => globalThis.pictures);
  const ask = (what, asked) => page.evaluate(([name, given]) => globalThis.pictures[name](given), [what, asked]);
  return { ask, close: () => browser.close() };
}

const onWebgl = await opened();
const { ask } = onWebgl;
const onWebgpu = await opened("--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader");

/** Writes both pictures, one above the other, to the folder PICTURES. */
function savePicture(name, ...pictures) {
  const bytes = Uint8Array.from(pictures.flat());
  writeFileSync(join(process.env.PICTURES, `${name.replace(/\W+/g, "_")}.png`), png(320, 240 * pictures.length, bytes));
}

let failed = 0;
async function check(name, body) {
  if (!new RegExp(pattern).test(name)) return;
  errors.length = 0;
  try {
    console.log(`ok - ${name}: ${(await body()) ?? ""}`);
    assert.deepEqual(errors, []);
  } catch (error) {
    ++failed;
    console.log(`not ok - ${name}\n  ${error.message}\n  ${errors.join("\n  ")}`);
  }
}

const light = [3, 2.5, 2, 0.4, 0.2, -0.3, -0.2, 0.5, 0.1, 0.6, -0.4, 0.3];

await check("texels have the radiance of their words, drawn once for each light", async () => {
  const lamps = { Lantern: [0.5, 0.25, 2] };
  const found = await ask("texels", { model: "texels.glb", light, lamps });
  const { set, view } = setOf(models["texels.glb"], "texels");
  const columns = lightColumns(clustersOf(set, view), light, null, lamps.Lantern);
  const clusters = clustersOf(set, view);
  let [most, mostHalf] = [0, 0];
  const seen = new Set();
  for (const { i, bytes, halves, floats } of found.maps)
    for (let y = 0; y < MAPS[i].height; ++y)
      for (let x = 0; x < MAPS[i].width; ++x) {
        const at = 4 * (y * MAPS[i].width + x);
        const words = texelWords(i, x, y);
        words.forEach((word, j) => {
          const expected = [word & 255, (word >> 8) & 255, (word >> 16) & 255, word >>> 24];
          assert.deepEqual(bytes[j].slice(at, at + 4), expected, `map ${i}, texel ${x}, ${y}, word ${j}`);
          if (expected[3] === 0) seen.add(`clear ${expected[0]}`);
          expected.forEach((byte, c) => seen.add(`${c}: ${byte}`));
        });
        radianceOfWords(clusters, columns, words).forEach((value, c) => {
          most = Math.max(most, Math.abs(floats[at + c] - value) / Math.max(Math.abs(value), 0.1));
          mostHalf = Math.max(mostHalf, Math.abs(DataUtils.fromHalfFloat(halves[at + c]) - value) / Math.max(Math.abs(value), 0.1));
        });
      }
  assert.ok(most < 1e-5 && mostHalf < 2 ** -10, `${most}, ${mostHalf}`);
  assert.ok(seen.size > 4 * 250, `${seen.size} values of bytes`);
  const first = DataUtils.fromHalfFloat(found.doubled[0]);
  assert.ok(first !== DataUtils.fromHalfFloat(found.maps[0].halves[0]), "a different light is drawn");
  assert.deepEqual([found.targets, found.once, found.unchanged, found.afterChange >= 6], [3, 3, 3, true]);
  assert.ok(found.same, "the first picture equals the second");
  assert.ok(found.again, "disposed maps are created again");
  return `${most.toExponential(1)} off in floats, ${mostHalf.toExponential(1)} in half floats`;
});

/** Mean difference of channels, of 255, and the largest. */
function compared(a, b) {
  let [sum, most, lit] = [0, 0, 0];
  a.forEach((value, i) => {
    if (i % 4 === 3) return;
    const off = Math.abs(value - b[i]);
    sum += off;
    most = Math.max(most, off);
    lit += value > 20 ? 1 : 0;
  });
  const share = lit / (0.75 * a.length);
  assert.ok(share > 0.2, `only ${share} of the picture shows anything`);
  return { mean: sum / (0.75 * a.length), most };
}

const cases = {
  "a sky": {},
  "a reflected environment": { environment: true },
  "suns": { suns: true },
  // On software WebGPU three's shadow maps stay empty, with any material.
  "suns with shadows, and an environment": { suns: true, shadows: true, environment: true, but: "webgpu" },
  "suns through sheets from below, and an unlit ball": { suns: "from below", model: "leaf" },
  "fog": { suns: true, fog: true, picture: "radiance" }, // three mixes it in before or behind the tone curve
  "other lights, which must not add light": { others: true },
  "cloned materials": { change: "clone", environment: true },
  // Earlier releases of WebGPURenderer rotate reflections opposite to backgrounds.
  ...(revision >= 184 ? { "a rotated environment": { environment: true, probed: true, change: "metal" } } : {}),
  "metals": { change: "metal" },
  "instances": { copies: "instances", suns: true },
  "clones": { copies: "clones" },
  "a light probe": { probed: true },
  "a second model with its own light": { besides: true },
  "a moving object in a volume, with environment and suns": { model: "moving", environment: true, suns: true, change: "moving" },
};
const other = { vertices: "texels.glb", texels: "vertices.glb" };
const given = (by, { model, besides, ...options }) => ({
  ...options,
  model: `${model ? `${model}_` : ""}${by}.glb`,
  besides: besides && other[by],
  light,
});

const agree = (a, b) => {
  const { mean, most } = compared(a, b);
  assert.ok(mean <= 0.5, `mean ${mean} of 255`);
  return `mean ${mean.toFixed(3)} of 255, at most ${most.toFixed(0)}`;
};

async function checkRenderers(by, what, options) {
  const pages = [["nodes", onWebgl, "picture"], ["webgpu", onWebgpu, "radiance"]];
  for (const [api, { ask: askThere }, usual] of pages.filter(([name]) => name !== options.but))
    await check(`${by}, ${what}: WebGPURenderer on ${api === "webgpu" ? "WebGPU" : "WebGL"} draws the same as WebGLRenderer`, async () => {
      const picture = options.picture ?? usual;
      const asked = given(by, options);
      const [expected, shown] = [await ask(picture, { api: "webgl", ...asked }), await askThere(picture, { api, ...asked })];
      if (process.env.PICTURES) savePicture(`${by}.${what}.${api}`, expected, shown);
      return agree(expected, shown);
    });
}

for (const by of ["vertices", "texels"]) for (const [what, options] of Object.entries(cases)) await checkRenderers(by, what, options);
await checkRenderers("weights", "predictors of position and normal", { suns: true });

for (const by of ["vertices", "texels"])
  for (const api of ["webgl", "nodes"])
    await check(`${by}, ${api}: instances are lit like clones`, async () => {
      const [instances, clones] = [await ask("picture", { api, ...given(by, { copies: "instances", suns: true }) }),
        await ask("picture", { api, ...given(by, { copies: "clones", suns: true }) })];
      return agree(instances, clones);
    });

await check("texels: without an environment the picture equals that of three's light map", async () => {
  const [ours, own] = [await ask("picture", { api: "webgl", ...given("texels", { change: "matte" }) }), await ask("picture", { api: "webgl", ...given("texels", { change: "three's own" }) })];
  const { mean } = compared(ours, own);
  // Later releases subtract reflected light although it is zero.
  assert.ok(mean < (revision < 184 ? 0.1 : 1), `mean ${mean} of 255`);
  return `mean ${mean.toFixed(3)} of 255`;
});

const [across, down] = [48, 40];
const volumeLight = Array.from({ length: 27 }, (_, i) => Math.cos(3 * i + 1) + (i < 3 ? 3 : 0));
/** Squares through both bricks and between probes, outside the box, and outside all bricks. */
const points = [
  { point: [-0.53, 0.61, -0.37], rotation: [0.3, 0.5, 0.1] },
  { point: [0.31, 0.13, -0.91], rotation: [-1.2, 0.2, 2.1] },
  { point: [-1.77, -0.41, -1.23], rotation: [0.4, 2.6, -0.3] },
  { point: [0.07, 1.23, 0.29], rotation: [1.1, -0.7, 0.9] },
];

/**
 * Returns the maximum difference between a square's picture and plain JavaScript, relative to the maximum
 * radiance.
 */
async function offPlain(askThere, asked, expected) {
  const { set, view } = setOf(models[asked.model], "probes");
  const volume = volumeOf(set, view);
  const columns = lightColumns(volume.clusters, volumeLight, null, [0.5, 2, 0.25]);
  const pixels = await askThere("lit", { ...asked, light: volumeLight, lamps: { Lantern: [0.5, 2, 0.25] }, size: [across, down] });
  const rotated = new Euler().fromArray(asked.rotation);
  const normal = new Vector3(0, 0, 1).applyEuler(rotated).toArray();
  let [most, brightest] = [0, 0];
  for (let y = 0; y < down; ++y)
    for (let x = 0; x < across; ++x) {
      const row = asked.api === "webgpu" ? down - 1 - y : y;
      const at = new Vector3((2 * (x + 0.5)) / across - 1, (2 * (y + 0.5)) / down - 1, 0).applyEuler(rotated);
      const incident = incidentAround(volume, asked.point.map((value, a) => value + at.toArray()[a]), normal, columns);
      // Nodes of three compute one view position, also for orthographic cameras.
      const towards = asked.api === "webgl" ? normal : new Vector3(0, 0, 2).applyEuler(rotated).sub(at).normalize().toArray();
      const cosine = normal.reduce((sum, value, a) => sum + value * towards[a], 0);
      const mirrored = normal.map((value, a) => 2 * cosine * value - towards[a]);
      expected(incident, normal, mirrored).forEach((value, c) => {
        most = Math.max(most, Math.abs(pixels[4 * (row * across + x) + c] - value));
        brightest = Math.max(brightest, value);
      });
    }
  return most / brightest;
}

for (const [api, askThere] of [["webgl", ask], ["nodes", ask], ["webgpu", onWebgpu.ask]]) {
  const matte = { api, model: "volume.glb", material: "matte", kind: "plain" };
  await check(`${api}: objects in a volume have the light of their position, equal to plain JavaScript`, async () => {
    const found = [];
    for (const floats of [true, false])
      for (const point of points) found.push(await offPlain(askThere, { ...matte, floats, ...point }, (incident, normal) => sumOf(incident, normal)));
    // Filters of half floats use fractions of a cell in 256ths, and neighbours differ by as much as all
    // light.
    assert.ok(Math.max(...found.slice(0, 4)) < 1e-5 && Math.max(...found.slice(4)) < 2 ** -8, found.join());
    return `${Math.max(...found.slice(0, 4)).toExponential(1)} off in floats, ${Math.max(...found.slice(4)).toExponential(1)} in half floats`;
  });
  await check(`${api}: skins, morphs, instances and a moved scene are lit at their positions`, async () => {
    for (const kind of ["skinned", "morphed", "instances"]) {
      const off = await offPlain(askThere, { ...matte, floats: true, kind, ...points[0] }, (incident, normal) => sumOf(incident, normal));
      assert.ok(off < 1e-5, `${kind}: ${off}`);
    }
    const off = await offPlain(askThere, { ...matte, floats: true, moved: { point: [0.5, -0.25, 2], rotation: [0.4, 1.3, -0.6] }, ...points[1] }, (incident, normal) => sumOf(incident, normal));
    assert.ok(off < 1e-5, `moved: ${off}`);
  });
  await check(`${api}: chrome mirrors incident light`, async () => {
    const off = await offPlain(askThere, { ...matte, material: "chrome", floats: true, ...points[1] }, (incident, normal, mirrored) =>
      sumOf(incident, mirrored, [1, 1, 1, 1]));
    assert.ok(off < 0.02, `${off}`); // error of three's fit for multiple scattering
    return `${off.toExponential(1)} off`;
  });
}

await check("occluders darken baked surfaces as plain JavaScript computes", async () => {
  const moved = [
    { point: [0.2, 0.7, -0.3], rotation: [0.3, 1.1, -0.2], scale: 1 },
    { point: [-0.6, 0.3, 0.5], rotation: [0, -0.4, 0], scale: 1.5 },
  ];
  const matrices = moved.map(({ point, rotation, scale }) =>
    new Matrix4().compose(new Vector3(...point), new Quaternion().setFromEuler(new Euler(...rotation)), new Vector3(scale, scale, scale)).toArray());
  const size = [16, 12];
  const [open, occluded, after] = await ask("occluded", { model: "vertices.glb", passer: "passer.glb", moved, centre: [0, 0], size, light });
  assert.deepEqual(after, open);
  let [most, least] = [0, 1];
  for (let y = 0; y < size[1]; ++y)
    for (let x = 0; x < size[0]; ++x) {
      const position = [(2 * (x + 0.5)) / size[0] - 1, 0, 1 - (2 * (y + 0.5)) / size[1]];
      const expected = leftAt(matrices, position, [0, 1, 0]);
      const at = 4 * (y * size[0] + x);
      least = Math.min(least, expected);
      for (let c = 0; c < 3; ++c) most = Math.max(most, Math.abs(occluded[at + c] / open[at + c] - expected));
    }
  // The reference integrates over a grid of directions, within 1e-3; filters use fractions in 256ths.
  assert.ok(least < 0.8 && most < 4e-3, `${most}; darkest ${least}`);
  return `${most.toExponential(1)} off, the darkest is ${least.toFixed(2)}`;
});

await check("lobes rotate with the skin in world-space light, equal to plain JavaScript", async () => {
  const size = [96, 96];
  let [most, seen] = [0, 0];
  for (const order of [2, 3, 4])
    for (const [pose, rotation] of [[[[0, 0, 0], [0, 0, 0]], [0, 0, 0]], [[[0.3, -0.2, 0.4], [-0.5, 0.4, -0.2]], [0.2, 0.3, 0.1]]]) {
      const sky = Array.from({ length: 3 * order * order }, (_, i) => 0.6 * Math.cos(3 * i + 1) + (i < 3 ? 3 : 0));
      const pixels = await ask("posed", { model: `lobes_${order}.glb`, pose, rotation, light: sky, size });
      const all = new Matrix4().makeRotationFromEuler(new Euler(...rotation));
      const bones = boneMatrices(pose).map((bone) => bone.premultiply(all));
      for (const square of squares()) {
        const { point, radiance } = radianceOf(square, bones, order, sky);
        const [x, y] = [point.x, point.y].map((value) => Math.floor(48 * (value + 1)));
        const at = 4 * (size[0] * y + x);
        if (!(pixels[at + 3] > 0)) continue; // out of the picture
        ++seen;
        radiance.forEach((value, c) => (most = Math.max(most, Math.abs(pixels[at + c] - value) / Math.max(value, 0.1))));
      }
    }
  assert.ok(seen > 150 && most < 1e-5, `${most} of ${seen}`);
  return `${most.toExponential(1)} off`;
});

await check("lobes have the light of the volume at their position, equal to plain JavaScript", async () => {
  const size = [480, 480];
  const { set, view } = setOf(models["volume.glb"], "probes");
  const volume = volumeOf(set, view);
  const columns = lightColumns(volume.clusters, volumeLight, null, null);
  const pose = [[0.3, -0.2, 0.4], [-0.5, 0.4, -0.2]];
  const bones = boneMatrices(pose);
  const pixels = await ask("posed", { model: "lobes_4.glb", volume: "volume.glb", pose, rotation: [0, 0, 0], light: volumeLight, size });
  let [most, brightest, seen] = [0, 0, 0];
  for (const square of squares()) {
    const { point } = radianceOf(square, bones, 4, new Float64Array(48));
    const [x, y] = [point.x, point.y].map((value) => Math.floor(240 * (value + 1)));
    const at = 4 * (size[0] * y + x);
    if (!(pixels[at + 3] > 0)) continue;
    ++seen;
    // The middle of a square lies between two corners of it, at which light is looked up.
    const corners = cornersOf(square, bones).map(({ point: corner, normal }) => {
      const incident = incidentAround(volume, corner, normal, columns);
      return radianceOf(square, bones, 4, [...incident.flat(), ...new Array(21).fill(0)]).radiance;
    });
    for (let c = 0; c < 3; ++c) {
      most = Math.max(most, Math.abs(pixels[at + c] - (corners[0][c] + corners[1][c]) / 2));
      brightest = Math.max(brightest, pixels[at + c]);
    }
  }
  most /= brightest;
  assert.ok(seen > 20 && most < 0.02, `${most} of ${seen}`); // a pixel is not the middle to a hundredth of the square
  return `${most.toExponential(1)} off`;
});

await check("a user's DirectionalLight with three's default bias has no more shadow grain than without the plug-in", async () => {
  const [columns, rows] = [320, 240];
  const ofLight = async (asked) => {
    const [shadowed, open] = [await ask("picture", { ...asked, shadows: true }), await ask("picture", { ...asked, shadows: false })];
    return shadowed.map((value, i) => value - open[i]);
  };
  const asked = { api: "webgl", model: "vertices.glb", light, suns: "own" };
  const alone = await ofLight({ ...asked, change: "alone" });
  const baked = await ofLight(asked);
  // Pixels that three alone shows fully lit, like their neighbours.
  const around = [-2, -1, 0, 1, 2].flatMap((y) => [-2, -1, 0, 1, 2].map((x) => 4 * (y * columns + x)));
  let [count, ofBaked, ofAlone] = [0, 0, 0];
  for (let y = 2; y < rows - 2; ++y)
    for (let x = 2; x < columns - 2; ++x) {
      const at = 4 * (y * columns + x) + 1;
      if (!around.every((step) => Math.abs(alone[at + step]) < 8)) continue;
      const highPass = (image) => image[at] - around.reduce((sum, step) => sum + image[at + step], 0) / around.length;
      ++count;
      ofBaked += highPass(baked) ** 2;
      ofAlone += highPass(alone) ** 2;
    }
  const [rms, rmsAlone] = [Math.sqrt(ofBaked / count), Math.sqrt(ofAlone / count)];
  assert.ok(count > 0.5 * columns * rows, `${count} pixels`);
  assert.ok(rms < rmsAlone + 0.1, `${rms}, three alone ${rmsAlone}`); // a tenth of a step of 8 bits
  return `high-pass rms ${rms.toFixed(3)} of 255, three alone ${rmsAlone.toFixed(3)}`;
});

await check("the plug-in for the other renderer is rejected", async () => {
  for (const by of ["vertices", "texels"]) {
    await assert.rejects(ask("picture", { api: "webgl", ...given(by, { wrong: true }) }), /WebGLRenderer needs PrtkitPlugin of prtkit-web$/m);
await assert.rejects(ask("picture", { api: "nodes", ...given(by, { wrong: true }) }), /WebGPURenderer needs PrtkitPlugin of prtkit-web\/webgpu/);
  }
});

await onWebgl.close();
await onWebgpu.close();
await server.close();
console.log(failed === 0 ? "all passed" : `${failed} failed`);
process.exit(failed === 0 ? 0 : 1);
