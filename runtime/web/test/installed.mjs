// Tests the package in a user's setup: packed, installed into an empty project, built by Vite, drawn by
// Chromium.
//   node test/installed.mjs
// Needs `npm run build` for a model and its sky, a chromium (CHROMIUM, default /usr/bin/chromium), and prt
// (PRT, default build/release). THREE names the folder of a different release of three than this project's.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { copyFileSync, cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { build, createServer, preview } from "vite";
import { environmentRotation, rotatedBy } from "../src/rotations.js";
import { distFolder } from "../../../examples/web/tools/folders.mjs";
import { ballScene } from "./ballScene.js";

const web = fileURLToPath(new URL("../", import.meta.url));
const prt = process.env.PRT ?? join(web, "../../build/release/cli/prt");
const three = process.env.THREE ?? join(web, "node_modules/three");
const folder = mkdtempSync(join(tmpdir(), "prtkit-installed-"));
const run = (program, ...options) => execFileSync(program, options, { cwd: folder, stdio: ["ignore", "pipe", "ignore"], encoding: "utf8" });
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));

// The project of a user: the tarball, three, a page, files that it serves.
const [{ filename }] = JSON.parse(run("npm", "pack", web, "--json", "--ignore-scripts"));
cpSync(join(web, "test/game"), folder, { recursive: true });
writeFileSync(join(folder, "package.json"), JSON.stringify({ name: "game", version: "1.0.0", type: "module" }));
run("npm", "install", "--offline", "--legacy-peer-deps", "--no-audit", "--no-fund", `./${filename}`);
symlinkSync(three, join(folder, "node_modules/three"), "dir");
mkdirSync(join(folder, "public"));
const served = (name) => join(folder, "public", name);
const { models, skies } = JSON.parse(readFileSync(join(distFolder, "models/models.json"), "utf8"));
copyFileSync(join(distFolder, models[0].levels[1].file), served("model.glb"));
copyFileSync(join(distFolder, skies[0].file), served("sky.exr"));
writeFileSync(join(folder, "ball.gltf"), ballScene());
run(prt, "bake", "ball.gltf", "-o", "ball.baked.glb", "--rays", "4096", "--bounces", "0");
run(prt, "compress", "ball.baked.glb", "-o", served("ball.glb"), "--bits", "float", "--clusters", "16", "--components", "16");

await build({ root: folder, base: "./", logLevel: "error", build: { chunkSizeWarningLimit: 2000 } });
const built = await preview({ root: folder, preview: { port: 0, host: "127.0.0.1" }, logLevel: "error" });
const developed = await createServer({ root: folder, server: { port: 0, host: "127.0.0.1" }, optimizeDeps: { exclude: ["prtkit-web"] }, logLevel: "error" });
await developed.listen();
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});

const errors = [];
async function openPage(server) {
  const page = await browser.newPage({ viewport: { width: 320, height: 180 } });
  page.setDefaultTimeout(120_000);
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("console", (line) => ["error", "warning"].includes(line.type()) && !/GPU stall|favicon|404|does not light baked meshes/.test(line.text()) && errors.push(line.text()));
  await page.goto(`http://127.0.0.1:${server.httpServer.address().port}/`);
  await page.waitForFunction(() => globalThis.game);
  return page;
}
const page = await openPage(built);
const ask = (what, options, where = page) => where.evaluate(([name, given]) => globalThis.game[name](given), [what, options]);

let failed = 0;
async function check(name, body) {
  errors.length = 0;
  try {
    console.log(`ok - ${name}: ${(await body()) ?? ""}`);
    assert.deepEqual(errors, []);
  } catch (error) {
    ++failed;
    console.log(`not ok - ${name}\n  ${error.message}`);
  }
}
const percent = (x) => `${(100 * x).toFixed(2)} %`;

const view = { model: "model.glb", sky: "sky.exr", position: [3.2, 2.6, 6.4], towards: [0, 0.4, 0], fieldOfView: 35 };

await check("Vite build and development server: a worker projects, and the pictures are equal", async () => {
  const other = await openPage(developed);
  const [a, b] = [await ask("likePrt", view), await ask("likePrt", view, other)];
  await other.close();
  const most = a.reduce((so, value, i) => Math.max(so, Math.abs(value - b[i])), 0);
  assert.ok(a.some((value, i) => i % 4 === 0 && value > 0.1) && most < 1e-3, `${most}`);
});

await check("the picture equals that of prt render", async () => {
  const shown = await ask("likePrt", view);
  const output = join(folder, "prt.png");
  run(prt, "render", served("model.glb"), "--lights", served("sky.exr"), "-o", output, "--device", "cpu", "--size", "320x180", "--samples", "3",
    "--camera", view.position.join(), "--look-at", view.towards.join(), "--fov", "35", "--window", "auto", "--exposure", "-1", "--suns", "0");
  const expected = await page.evaluate(async (source) => {
    const image = new Image();
    image.src = source;
    await image.decode();
    const sheet = new OffscreenCanvas(image.width, image.height).getContext("2d");
    sheet.drawImage(image, 0, 0);
    return [...sheet.getImageData(0, 0, image.width, image.height).data];
  }, `data:image/png;base64,${readFileSync(output).toString("base64")}`);
  const curve = (v) => Math.min(Math.max((v * (2.51 * v + 0.03)) / (v * (2.43 * v + 0.59) + 0.14), 0), 1);
  const encoded = (v) => 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
  let sum = 0;
  for (let y = 0; y < 180; ++y)
    for (let x = 0; x < 320; ++x)
      for (let c = 0; c < 3; ++c)
        sum += Math.abs(encoded(curve(0.5 * shown[4 * ((179 - y) * 320 + x) + c])) - expected[4 * (y * 320 + x) + c]);
  const mean = sum / (3 * 180 * 320);
  assert.ok(mean < 1, `mean ${mean}`); // no antialiasing here, and the background through a cube map
  return `mean ${mean.toFixed(3)} of 255, with the sky`;
});

// Three's diffuse light is a blurred environment: exact for a uniform one, a few percent off for others.
for (const [metalness, side, rotation, most] of [[0, 0, [0, 0, 0], 0.01], [0.5, 0, [0, 0, 0], 0.01], [0, 0.3, [0, 0, 0], 0.05], [0, 0.3, [0.4, -0.7, 1.1], 0.05]])
  await check(`an unoccluded ball of metalness ${metalness} in a sky uneven by ${side}, rotated by ${rotation}, matches three's lighting`, async () => {
    const { own, rotated, others } = await ask("ball", { model: "ball.glb", rotation, metalness, side });
    assert.ok(own.rms < most, JSON.stringify(own));
    assert.ok(rotated.rms < 0.01, `the model rotated: ${rotated.rms}`);
    assert.ok(others.rms < 1e-3, `ambient and point lights add to it: ${others.rms}`);
    return `${percent(own.rms)} rms, means ${own.ratio.toFixed(4)} times; rotated itself ${percent(rotated.rms)}`;
  });

await check("backgrounds rotate as expected", async () => {
  const revision = Number.parseInt(JSON.parse(readFileSync(join(three, "package.json"), "utf8")).version.split(".")[1]);
  const { Euler } = await import("three");
  const [x, y] = [90, 20];
  // Direction of a texel of a flipped image of 128 x 64: +X in the middle, +Z a quarter of the width to its
  // right.
  const [azimuth, theta] = [2 * Math.PI * ((x + 0.5) / 128 - 0.5), (Math.PI * (y + 0.5)) / 64];
  const direction = [Math.sin(theta) * Math.cos(azimuth), Math.cos(theta), Math.sin(theta) * Math.sin(azimuth)];
  for (const rotation of [[0, 0, 0], [0, 1, 0], [0.4, -0.7, 1.1]]) {
    const seen = rotatedBy(environmentRotation(new Euler(...rotation), revision), direction);
    assert.ok((await ask("inTheMiddle", { rotation, direction: seen, at: [x, y] })) > 10, `${rotation}`);
    assert.ok((await ask("inTheMiddle", { rotation, direction: seen.map((v) => -v), at: [x, y] })) < 1, `${rotation}`);
  }
});

await check("instances and clones have equal light, with shadows and fog", async () => {
  const { instances, unshadowed, fog } = await ask("copies", { model: "model.glb" });
  assert.ok(instances.rms < 0.01, `instances: ${instances.rms}`);
  assert.ok(unshadowed.ratio > 1.03, `shadows take ${unshadowed.ratio}`);
  assert.ok(fog < 0.01, `fog: ${fog}`);
  return `instances ${percent(instances.rms)} off, shadows take ${percent(1 - 1 / unshadowed.ratio)}`;
});

await browser.close();
await developed.close();
built.httpServer.close();
console.log(failed === 0 ? "all passed" : `${failed} failed`);
process.exit(failed === 0 ? 0 : 1);
