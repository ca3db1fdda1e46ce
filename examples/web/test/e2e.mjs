// The built page in headless Chromium: its pictures against those of `prt render`, its controls, its messages.
//   node test/e2e.mjs [FOLDER for screenshots]
// Needs `npm run build`, a chromium (CHROMIUM, else /usr/bin/chromium), and prt (PRT, else build/release).
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { preview } from "vite";
import { distFolder } from "../tools/folders.mjs";

const web = fileURLToPath(new URL("../", import.meta.url));
const prt = process.env.PRT ?? join(web, "../../build/release/cli/prt");
const screenshots = process.argv[2];
if (screenshots) mkdirSync(screenshots, { recursive: true });
const work = mkdtempSync(join(tmpdir(), "prtkit-web-"));
const [width, height] = [640, 360];

// Both draw the same light with the same shader and tone curve. What differs: antialiasing of edges (WebGL's against
// 3 x 3 samples), texture filtering, and 8 bits of rounding.
const MEAN_TOLERANCE = 0.5; // of 255
const FAR = 16;
const FAR_SHARE = 0.01; // of the pixels

const server = await preview({ root: web, preview: { port: 0, host: "127.0.0.1" }, logLevel: "error" });
const { port } = server.httpServer.address();
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--no-first-run"],
});

let failed = 0;
async function check(name, body) {
  const page = await browser.newPage({ viewport: { width, height } });
  const errors = [];
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("console", (line) => line.type() === "error" && errors.push(line.text()));
  try {
    await body(page, errors);
    console.log(`ok - ${name}`);
  } catch (error) {
    ++failed;
    console.log(`not ok - ${name}\n  ${error.message}\n  ${errors.join("\n  ")}`);
  }
  await page.close();
}

const url = (query) => `http://127.0.0.1:${port}/?${new URLSearchParams(query)}`;
const picture = (page, past = 0) =>
  page.waitForFunction((n) => globalThis.prtkitPicture?.drawn > n, past, { timeout: 60000 });
const drawn = (page) => page.evaluate(() => globalThis.prtkitPicture.drawn);
const canvas = (page) => page.evaluate(() => document.getElementById("view").toDataURL("image/png"));
const dataUrl = (file) => `data:image/png;base64,${readFileSync(file).toString("base64")}`;

/** Mean difference of channels in 255ths, and the share of pixels that differ by more than FAR. */
const difference = (page, a, b) =>
  page.evaluate(
    async ([first, second, far]) => {
      const pixels = await Promise.all(
        [first, second].map(async (source) => {
          const image = new Image();
          image.src = source;
          await image.decode();
          const sheet = new OffscreenCanvas(image.width, image.height).getContext("2d");
          sheet.drawImage(image, 0, 0);
          return sheet.getImageData(0, 0, image.width, image.height).data;
        }),
      );
      if (pixels[0].length !== pixels[1].length) throw new Error("the pictures have different sizes");
      let sum = 0;
      let count = 0;
      for (let i = 0; i < pixels[0].length; i += 4) {
        let most = 0;
        for (let c = 0; c < 3; ++c) {
          const d = Math.abs(pixels[0][i + c] - pixels[1][i + c]);
          sum += d / 3;
          most = Math.max(most, d);
        }
        if (most > far) ++count;
      }
      return { mean: (4 * sum) / pixels[0].length, far: (4 * count) / pixels[0].length };
    },
    [a, b, FAR],
  );

function render(file, angle, { position, target, fieldOfView }, sky = join(distFolder, "skies/sky.exr")) {
  const output = join(work, "reference.png");
  execFileSync(prt, ["render", join(distFolder, file), "--env", sky, "-o", output,
    "--rotate", String(angle), "--size", `${width}x${height}`, "--samples", "3", "--camera", position.join(","),
    "--look-at", target.join(","), "--fov", String(fieldOfView)], { stdio: "ignore" });
  return dataUrl(output);
}

const { models } = JSON.parse(readFileSync(join(distFolder, "models/models.json"), "utf8"));
const camera = { position: [3.2, 2.6, 6.4], target: [0, 0.4, 0], fieldOfView: 35 };
const query = (view) => ({
  camera: view.position.join(","),
  target: view.target.join(","),
  fov: view.fieldOfView,
  panel: 0,
});

for (const [i, model] of models.entries())
  for (const [quality, level] of model.levels.entries())
    await check(`${model.name}, ${level.title}: the picture is that of prt render`, async (page, errors) => {
      const view = { fieldOfView: 35, ...(model.camera ?? camera) };
      const angle = 40 * i - 30 + 75 * quality;
      await page.goto(url({ model: model.name, quality, angle, ...query(view) }));
      await picture(page);
      const shown = await canvas(page);
      const d = await difference(page, shown, render(level.file, angle, view));
      console.log(`  mean ${d.mean.toFixed(3)} of 255, ${(100 * d.far).toFixed(2)} % of the pixels differ by more than ${FAR}`);
      if (screenshots) writeFileSync(join(screenshots, `${model.name}.${quality}.png`), Buffer.from(shown.split(",")[1], "base64"));
      assert.deepEqual(errors, []);
      assert.ok(d.mean < MEAN_TOLERANCE, `mean difference ${d.mean}`);
      assert.ok(d.far < FAR_SHARE, `${d.far} of the pixels differ`);
    });

/** A Radiance file of flat RGBE pixels: sky above, ground below, a warm side. */
function radianceFile(path) {
  const [columns, rows] = [64, 32];
  const pixels = Buffer.alloc(4 * columns * rows);
  for (let y = 0; y < rows; ++y)
    for (let x = 0; x < columns; ++x) {
      const warm = x > 8 && x < 20 && y > 6 && y < 14;
      pixels.set(warm ? [250, 180, 90, 131] : y < 16 ? [90, 120, 200, 128] : [120, 100, 80, 126], 4 * (y * columns + x));
    }
  writeFileSync(path, Buffer.concat([Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${rows} +X ${columns}\n`), pixels]));
}

await check("a Radiance sky lights as prt render does", async (page, errors) => {
  const sky = join(work, "warm.hdr");
  radianceFile(sky);
  await page.route("**/models.json", async (route) => {
    const manifest = await (await route.fetch()).json();
    await route.fulfill({ json: { ...manifest, skies: [{ title: "warm", file: "skies/warm.hdr" }] } });
  });
  await page.route("**/warm.hdr", (route) => route.fulfill({ body: readFileSync(sky) }));
  await page.goto(url({ model: "knot", angle: 25, ...query(camera) }));
  await picture(page);
  const d = await difference(page, await canvas(page), render(models[0].levels[0].file, 25, camera, sky));
  console.log(`  mean ${d.mean.toFixed(3)} of 255`);
  assert.deepEqual(errors, []);
  assert.ok(d.mean < 2 * MEAN_TOLERANCE, `mean difference ${d.mean}`); // a few texels fill the background
});

await check("dragging with the right button turns the light", async (page, errors) => {
  await page.goto(url({ model: "knot", ...query(camera) }));
  await picture(page);
  const before = await canvas(page);
  const count = await drawn(page);
  await page.mouse.move(400, 200);
  await page.mouse.down({ button: "right" });
  await page.mouse.move(580, 200, { steps: 4 }); // half the height: a quarter turn
  await page.mouse.up({ button: "right" });
  await picture(page, count);
  await page.waitForTimeout(200);
  const angle = await page.evaluate(() => (globalThis.prtkitPicture.angle * 180) / Math.PI);
  assert.ok(Math.abs(angle - 90) < 1, `turned by ${angle}`);
  const after = await canvas(page);
  assert.ok((await difference(page, before, after)).mean > 5);
  const d = await difference(page, after, render(models[0].levels[0].file, angle, camera));
  assert.ok(d.mean < MEAN_TOLERANCE, `mean difference ${d.mean}`);
  assert.deepEqual(errors, []);
});

await check("the panel chooses model and quality, and shows bytes", async (page, errors) => {
  await page.goto(url({ model: "knot" }));
  await picture(page);
  const bytes = () => page.locator("#figures dd").nth(1).innerText();
  const first = Number(await bytes());
  assert.ok(first > 4 && first < 40, `bytes per vertex ${first}`);
  let count = await drawn(page);
  await page.selectOption("#quality", { index: 2 });
  await page.waitForFunction((f) => Number(document.querySelectorAll("#figures dd")[1].innerText) !== f, first);
  assert.ok(Number(await bytes()) > first);
  count = await drawn(page);
  await page.selectOption("#model", { index: 1 });
  await picture(page, count);
  if (screenshots) await page.screenshot({ path: join(screenshots, "page.png") });
  assert.deepEqual(errors, []);
});

await check("a model that is missing gives a message", async (page) => {
  await page.route("**/*.glb", (route) => route.fulfill({ status: 404, body: "" }));
  await page.goto(url({ model: "knot" }));
  await page.waitForSelector("#message:not([hidden])");
});

await check("a model without transfer gives a message", async (page) => {
  const json = JSON.stringify({ asset: { version: "2.0" }, scenes: [{ nodes: [] }], scene: 0 });
  const text = Buffer.from(json.padEnd(Math.ceil(json.length / 4) * 4));
  const head = Buffer.alloc(20);
  head.write("glTF");
  [2, 20 + text.length, text.length].forEach((value, i) => head.writeUInt32LE(value, 4 + 4 * i));
  head.write("JSON", 16);
  await page.route("**/*.glb", (route) => route.fulfill({ body: Buffer.concat([head, text]) }));
  await page.goto(url({ model: "knot" }));
  await page.waitForSelector("#message:not([hidden])");
  assert.match(await page.locator("#message").innerText(), /prt bake/);
});

await browser.close();
server.httpServer.close();
rmSync(work, { recursive: true });
console.log(failed === 0 ? "all passed" : `${failed} failed`);
process.exit(failed === 0 ? 0 : 1);
