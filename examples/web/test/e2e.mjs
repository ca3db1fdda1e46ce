// Tests the built page in headless Chromium: compares its pictures with `prt render`, and tests its controls and
// messages.
//   node test/e2e.mjs [FOLDER for screenshots] [PATTERN of the names of checks, default all]
// Needs `npm run build`, a chromium (CHROMIUM, default /usr/bin/chromium), and prt (PRT, default
// build/release).
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { preview } from "vite";
import { distFolder } from "../tools/folders.mjs";
import { bakedModel } from "../../../runtime/web/test/bakedModel.js";
import { setIn } from "../../../runtime/web/test/transferSets.js";

const web = fileURLToPath(new URL("../", import.meta.url));
const prt = process.env.PRT ?? join(web, "../../build/release/cli/prt");
const [, , screenshots, pattern = ""] = process.argv;
if (screenshots) mkdirSync(screenshots, { recursive: true });
const work = mkdtempSync(join(tmpdir(), "prtkit-web-"));
const [width, height] = [640, 360];

// Both draw with the same light, shader and tone curve. They differ in the antialiasing of edges (WebGL's
// against 3 x 3 samples), in texture filtering, and in rounding to 8 bits.
const MEAN_TOLERANCE = 0.5; // levels out of 255
const FAR = 16;
const METERED = 0.1; // stops: grids of 48 x 48 points see edges and textures a little differently
const FAR_SHARE = 0.01; // fraction of the pixels

const server = await preview({ root: web, preview: { port: 0, host: "127.0.0.1" }, logLevel: "error" });
const { port } = server.httpServer.address();
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--no-first-run"],
});

let failed = 0;
let checked = 0;
async function check(name, body) {
  if (!new RegExp(pattern).test(name)) return;
  ++checked;
  const page = await browser.newPage({ viewport: { width, height } });
  page.setDefaultTimeout(120_000); // a busy machine must not fail the test
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

// Pages show no walking figure, except in its test: prt renders only baked geometry.
const url = (query) => `http://127.0.0.1:${port}/?${new URLSearchParams({ figure: 0, ...query })}`;
const picture = (page, past = 0) =>
  page.waitForFunction((n) => globalThis.prtkitPicture?.drawn > n, past, { timeout: 120_000 });
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


const { models, skies } = JSON.parse(readFileSync(join(distFolder, "models/models.json"), "utf8"));
const exampleSky = join(distFolder, skies[0].file);

/** Returns the picture of prt with the page's exposure; prt's own exposure may differ by METERED stops. */
async function render(page, file, angle, { position, target, fieldOfView }, { sky = exampleSky, window = "auto", suns = "0" } = {}) {
  const output = join(work, "reference.png");
  const json = join(work, "reference.json");
  const exposure = await page.evaluate(() => Math.log2(globalThis.prtkitPicture.renderer.toneMappingExposure));
  const run = (stops) =>
    execFileSync(prt, ["render", join(distFolder, file), "--lights", sky, "-o", output, "--json", json, "--device", "cpu",
      "--rotate", String(angle), "--size", `${width}x${height}`, "--samples", "3", "--camera", position.join(","),
      "--look-at", target.join(","), "--window", window, "--fov", String(fieldOfView), "--exposure", stops,
      "--suns", suns, "--suns", "rays=64"], { stdio: "ignore" });
  run("auto");
  const metered = JSON.parse(readFileSync(json, "utf8")).exposure_stops;
  assert.ok(Math.abs(metered - exposure) < METERED, `the page meters ${exposure} stops, prt ${metered}`);
  run(String(exposure));
  return dataUrl(output);
}

// The page shows skies with +X in the middle, like three; prt shows +Z there.
const THREE_ROTATION = 90;

const standardCamera = { position: [3.2, 2.6, 6.4], target: [0, 0.4, 0], fieldOfView: 35 };
const query = (view) => ({
  camera: view.position.join(","),
  target: view.target.join(","),
  fov: view.fieldOfView,
  panel: 0,
  suns: 0,
});

/** Returns the radiance of vertices that prt wrote as colors: vec3 floats for each mesh and primitive. */
function vertexColors(path) {
  const bytes = readFileSync(path);
  const jsonBytes = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.toString("utf8", 20, 20 + jsonBytes));
  return json.meshes.map(({ primitives }) =>
    primitives.map(({ attributes }) => {
      const { bufferView, byteOffset = 0, count, componentType, type } = json.accessors[attributes.COLOR_0];
      assert.deepEqual([componentType, type], [5126, "VEC3"]);
      const view = json.bufferViews[bufferView];
      const at = 20 + jsonBytes + 8 + (view.byteOffset ?? 0) + byteOffset;
      const stride = view.byteStride ?? 12;
      return Array.from({ length: 3 * count }, (_, i) => bytes.readFloatLE(at + Math.floor(i / 3) * stride + 4 * (i % 3)));
    }),
  );
}

/**
 * Compares linear radiance of the page with `colors` of vertices, both drawn in the same way. Uses pixels
 * whose color changes little between neighbours, because vertices do not resolve sharp shadows. Returns the
 * root mean squared difference relative to that of the radiance, the ratio of the means, and the fraction of
 * such pixels.
 */
const radianceAgainst = (page, colors) =>
  page.evaluate((truth) => {
    const { renderer, scene, camera, meter, background, gltf } = globalThis.prtkitPicture;
    const [columns, rows] = [960, 540];
    const Target = meter.target.constructor;
    const target = new Target(columns, rows, { type: meter.target.texture.type });
    const pixels = () => {
      const result = new Float32Array(4 * columns * rows);
      renderer.setRenderTarget(target);
      renderer.clear();
      renderer.render(scene, camera);
      renderer.readRenderTargetPixels(target, 0, 0, columns, rows, result);
      renderer.setRenderTarget(null);
      return result;
    };
    background.visible = false;
    const shown = pixels();
    const Material = background.material.constructor;
    gltf.scene.traverse((object) => {
      if (!object.isMesh) return;
      const { meshes, primitives } = gltf.parser.associations.get(object);
      const Attribute = object.geometry.index.constructor;
      object.geometry.setAttribute("truth", new Attribute(new Float32Array(truth[meshes][primitives]), 3));
      object.material = new Material({
        side: object.material.side,
        vertexShader: `attribute vec3 truth; varying vec3 color;
          void main() { color = truth; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`,
        fragmentShader: "varying vec3 color; void main() { gl_FragColor = vec4(color, 1.0); }",
      });
    });
    const expected = pixels();
    const green = (x, y) => (expected[4 * (y * columns + x) + 3] > 0 ? expected[4 * (y * columns + x) + 1] : NaN);
    let [squares, differences, sum, meanShown, even, covered] = [0, 0, 0, 0, 0, 0];
    for (let y = 2; y < rows - 2; ++y)
      for (let x = 2; x < columns - 2; ++x) {
        if (!(expected[4 * (y * columns + x) + 3] > 0)) continue;
        ++covered;
        let [low, high] = [Infinity, -Infinity];
        for (let dy = -2; dy <= 2; ++dy)
          for (let dx = -2; dx <= 2; ++dx) {
            const value = green(x + dx, y + dy);
            low = Number.isNaN(value) ? -Infinity : Math.min(low, value);
            high = Math.max(high, value);
          }
        if (!(high - low < 0.05 * high)) continue;
        ++even;
        for (let c = 0; c < 3; ++c) {
          const i = 4 * (y * columns + x) + c;
          squares += expected[i] ** 2;
          differences += (shown[i] - expected[i]) ** 2;
          sum += expected[i];
          meanShown += shown[i];
        }
      }
    return { rms: Math.sqrt(differences / squares), ratio: meanShown / sum, even: even / covered };
  }, colors);

/**
 * Removes the specular reflection of suns, which three adds to Lambert's law and prt does not have, by a
 * further change before compiling, as programs do.
 */
async function matte(page) {
  const count = await drawn(page);
  await page.evaluate(() => {
    globalThis.prtkitPicture.gltf.scene.traverse(({ material }) => {
      if (!material) return;
      const { onBeforeCompile } = material;
      material.onBeforeCompile = (shader, renderer) => {
        onBeforeCompile(shader, renderer);
        shader.fragmentShader = shader.fragmentShader.replace("reflectedLight.directSpecular + reflectedLight.indirectSpecular", "vec3( 0.0 )");
      };
      material.customProgramCacheKey = ((key) => () => `matte:${key()}`)(material.customProgramCacheKey);
      material.needsUpdate = true;
    });
    globalThis.prtkitPicture.draw();
  });
  await picture(page, count);
}

// Lobes have no bake that prt renders; prt writes radiance of instances with shared transfer to separate
// nodes.
const poseless = models.filter(({ clip }) => !clip);
const normal = ({ levels }) => levels[1] ?? levels[0];
/**
 * Returns a view of instances closer than on the page: otherwise edges, which both antialias differently,
 * would dominate the difference.
 */
const viewOf = ({ camera, shares }) => ({ fieldOfView: 35, ...(camera ?? standardCamera), ...(shares ? { fieldOfView: 12 } : {}) });

for (const [i, model] of poseless.filter(({ shares }) => !shares).entries())
  for (const angle of [25 + 40 * i, 200])
    await check(`${model.name}, rotated by ${angle}: suns light like prt relight by rays`, async (page, errors) => {
      const view = viewOf(model);
      const { file } = normal(model);
      await page.goto(url({ model: model.name, quality: 1, angle, ...query(view), suns: 1 }));
      await picture(page);
      assert.equal(await page.evaluate(() => globalThis.prtkitPicture.canSeparateSuns), true);
      await matte(page);
      const lit = join(work, "lit.glb");
      execFileSync(prt, ["relight", join(distFolder, file), "--lights", join(distFolder, skies[0].light), "-o", lit, "--colors", "albedo",
        "--window", "auto", "--rotate", String(angle)], { stdio: "ignore" });
      const d = await radianceAgainst(page, vertexColors(lit));
      console.log(`  ${(100 * d.rms).toFixed(2)} % rms, means ${d.ratio.toFixed(4)} times, over ${(100 * d.even).toFixed(0)} % of the model`);
      assert.deepEqual(errors, []);
      // Error of 32 taps of the shadow map against 256 rays, and of pixels with little change inside a wide
      // penumbra.
      assert.ok(d.rms < 0.02, `${d.rms}`);
    });

for (const [i, model] of poseless.entries())
  for (const [quality, level] of model.levels.entries())
    await check(`${model.name}, ${level.title}: the picture equals that of prt render`, async (page, errors) => {
      const view = viewOf(model);
      const angle = 40 * i - 30 + 75 * quality;
      await page.goto(url({ model: model.name, quality, angle, ...query(view) }));
      await picture(page);
      const shown = await canvas(page);
      const expected = await render(page, level.file, angle, view);
      const d = await difference(page, shown, expected);
      console.log(`  mean ${d.mean.toFixed(3)} of 255, ${(100 * d.far).toFixed(2)} % of the pixels differ by more than ${FAR}`);
      if (screenshots)
        for (const [suffix, drawing] of [["", shown], [".prt", expected]])
          writeFileSync(join(screenshots, `${model.name}.${quality}${suffix}.png`), Buffer.from(drawing.split(",")[1], "base64"));
      assert.deepEqual(errors, []);
      assert.ok(d.mean < MEAN_TOLERANCE, `mean difference ${d.mean}`);
      assert.ok(d.far < FAR_SHARE, `${d.far} of the pixels differ`);
    });

for (const [i, model] of poseless.entries())
  await check(`${model.name}: with separate suns the picture equals that of prt render by rays`, async (page, errors) => {
    const view = viewOf(model);
    const angle = 15 + 50 * i;
    await page.goto(url({ model: model.name, quality: 1, angle, ...query(view), suns: 1 }));
    await picture(page);
    await matte(page);
    const shown = await canvas(page);
    const expected = await render(page, normal(model).file, angle, view, { suns: "auto" });
    const d = await difference(page, shown, expected);
    console.log(`  mean ${d.mean.toFixed(3)} of 255, ${(100 * d.far).toFixed(2)} % of the pixels differ by more than ${FAR}`);
    if (screenshots) {
      writeFileSync(join(screenshots, `${model.name}.suns.png`), Buffer.from(shown.split(",")[1], "base64"));
      writeFileSync(join(screenshots, `${model.name}.suns.prt.png`), Buffer.from(expected.split(",")[1], "base64"));
    }
    assert.deepEqual(errors, []);
    // Facets of the forest are coarse: some face away from the sun before the normals of their vertices do.
    const times = model.shares ? 3 : 2;
    assert.ok(d.mean < times * MEAN_TOLERANCE, `mean difference ${d.mean}`);
    assert.ok(d.far < times * FAR_SHARE, `${d.far} of the pixels differ`);
  });

for (const model of models.filter(({ clip }) => clip))
  await check(`${model.name} dances in its own light`, async (page, errors) => {
    await page.goto(url({ model: model.name, angle: 40, suns: 0, panel: 0 }));
    await picture(page, 3);
    const lit = await page.evaluate(() => {
      const shown = globalThis.prtkitPicture;
      shown.still = true;
      const { prtkit } = shown.gltf.userData;
      return [prtkit.lobes, prtkit.vertices, shown.dance.time];
    });
    assert.ok(lit[0] >= 1 && lit[1] > 1000 && lit[2] > 0, lit.join());
    const count = await drawn(page);
    await page.evaluate(() => globalThis.prtkitPicture.draw());
    await picture(page, count);
    const before = await canvas(page);
    if (screenshots) writeFileSync(join(screenshots, `${model.name}.dance.png`), Buffer.from(before.split(",")[1], "base64"));
    const next = await drawn(page);
    await page.evaluate(() => {
      globalThis.prtkitPicture.dance.update(0.4);
      globalThis.prtkitPicture.draw();
    });
    await picture(page, next);
    assert.ok((await difference(page, before, await canvas(page))).mean > 0.1, "it moves");
    assert.deepEqual(errors, []);
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

const warmSky = join(work, "warm.hdr");
radianceFile(warmSky);
const onlyWarmSky = async (page) => {
  const manifest = { models, skies: [{ title: "warm", file: "skies/warm.hdr" }] };
  await page.route("**/models.json", (route) => route.fulfill({ json: manifest }));
  await page.route("**/warm.hdr", (route) => route.fulfill({ body: readFileSync(warmSky) }));
};

await check("a Radiance sky lights like prt render", async (page, errors) => {
  await onlyWarmSky(page);
  await page.goto(url({ model: "knot", angle: 25, ...query(standardCamera) }));
  await picture(page);
  const d = await difference(page, await canvas(page),
    await render(page, models[0].levels[0].file, 25 + THREE_ROTATION, standardCamera, { sky: warmSky }));
  console.log(`  mean ${d.mean.toFixed(3)} of 255`);
  assert.deepEqual(errors, []);
  assert.ok(d.mean < 2 * MEAN_TOLERANCE, `mean difference ${d.mean}`); // a few texels fill the background
});

await check("the sky has the orientation of three's background", async (page, errors) => {
  await onlyWarmSky(page);
  const upwards = { position: [1, 0.5, 6], target: [0, 2.2, 0], fieldOfView: 70 }; // the warm side is in view
  const angle = 20; // rotation of the light, equal to three's rotation
  await page.goto(url({ model: "knot", angle, ...query(upwards) }));
  await picture(page);
  const before = await canvas(page);
  if (screenshots) writeFileSync(join(screenshots, "own-background.png"), Buffer.from(before.split(",")[1], "base64"));
  const count = await drawn(page);
  const showThrees = (rotation) =>
    page.evaluate((radians) => {
      const shown = globalThis.prtkitPicture;
      const texture = shown.background.material.uniforms.environment.value;
      texture.mapping = 303; // EquirectangularReflectionMapping
      shown.background.visible = false;
      shown.scene.background = texture;
      shown.scene.backgroundRotation.y = radians;
      shown.expose = () => {}; // keep the exposure
      shown.draw();
    }, rotation);
  await showThrees((angle * Math.PI) / 180);
  await picture(page, count);
  const same = (await difference(page, before, await canvas(page))).mean;
  const next = await drawn(page);
  await showThrees((-angle * Math.PI) / 180);
  await picture(page, next);
  const rotated = (await difference(page, before, await canvas(page))).mean;
  console.log(`  mean ${same.toFixed(3)} of 255, rotated the other way ${rotated.toFixed(3)}`);
  assert.deepEqual(errors, []);
  assert.ok(same < 2, `mean difference ${same}`); // three converts it to a cube map
  assert.ok(rotated > 5 * same);
});

for (const window of ["none", "hann", "lanczos"])
  await check(`window ${window}: the picture equals that of prt render`, async (page, errors) => {
    await page.goto(url({ model: "knot", window, ...query(standardCamera) }));
    await picture(page);
    const d = await difference(page, await canvas(page),
      await render(page, models[0].levels[0].file, 0, standardCamera, { window }));
    assert.ok(d.mean < MEAN_TOLERANCE, `mean difference ${d.mean}`);
    assert.deepEqual(errors, []);
  });

await check("dragging with the right button rotates the light", async (page, errors) => {
  await page.goto(url({ model: "knot", ...query(standardCamera) }));
  await picture(page);
  const before = await canvas(page);
  const count = await drawn(page);
  await page.mouse.move(400, 200);
  await page.mouse.down({ button: "right" });
  await page.mouse.move(580, 200, { steps: 4 }); // half the height: a quarter rotation
  await page.mouse.up({ button: "right" });
  await picture(page, count);
  await page.waitForTimeout(200);
  const angle = await page.evaluate(() => (globalThis.prtkitPicture.angle * 180) / Math.PI);
  assert.ok(Math.abs(angle - 90) < 1, `rotated by ${angle}`);
  const after = await canvas(page);
  assert.ok((await difference(page, before, after)).mean > 5);
  const d = await difference(page, after, await render(page, models[0].levels[0].file, angle, standardCamera));
  assert.ok(d.mean < MEAN_TOLERANCE, `mean difference ${d.mean}`);
  assert.deepEqual(errors, []);
});

await check("the panel selects model and quality, and shows bytes", async (page, errors) => {
  await page.goto(url({ model: "knot" }));
  await picture(page);
  const words = await page.locator("#quality option").allTextContents();
  ["small", "normal", "fine"].forEach((word, i) => assert.match(words[i], new RegExp(`^${word}: [0-9.]+ bytes per vertex$`)));
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

/** `files`: paths by name. */
const dropped = (page, files) =>
  page.evaluate(
    async (contents) => {
      const transfer = new DataTransfer();
      for (const [name, bytes] of contents)
        transfer.items.add(new File([Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0))], name));
      dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));
    },
    Object.entries(files).map(([name, path]) => [name, readFileSync(path).toString("base64")]),
  );

await check("dropped files are shown and listed", async (page, errors) => {
  await page.goto(url({ model: "knot", panel: 0 }));
  await picture(page);
  let count = await drawn(page);
  await dropped(page, { "warm.hdr": warmSky });
  await page.waitForFunction(() => document.querySelector("#sky").selectedOptions[0].text === "warm.hdr");
  await picture(page, count);
  count = await drawn(page);
  const other = poseless.at(-1);
  await dropped(page, { "mine.glb": join(distFolder, normal(other).file) });
  await page.waitForFunction(() => document.querySelector("#model").selectedOptions[0].text === "mine.glb");
  await picture(page, count);
  // Shows the model as if it was chosen from the list, from the same camera.
  const view = await page.evaluate(() => {
    const { camera, controls, fieldOfView } = globalThis.prtkitPicture;
    return { position: camera.position.toArray(), target: controls.target.toArray(), fieldOfView };
  });
  const d = await difference(page, await canvas(page), await render(page, normal(other).file, THREE_ROTATION, view, { sky: warmSky }));
  assert.ok(d.mean < 2 * MEAN_TOLERANCE, `mean difference ${d.mean}`);
  assert.deepEqual(errors, []);
  await dropped(page, { "notes.txt": warmSky });
  await page.waitForSelector("#message:not([hidden])");
  assert.match(await page.locator("#message").innerText(), /notes\.txt/);
  await dropped(page, { "broken.glb": warmSky });
  await page.waitForFunction(() => /broken\.glb/.test(document.querySelector("#message").innerText));
  assert.equal(await page.locator("#model option").count(), models.length + 1); // the broken one is not listed
});

/** A floor of 4 m, a square of half a metre that hangs over it, and lights of KHR_lights_punctual. */
function lampScene(path, lights) {
  const positions = [];
  const normals = [];
  const indices = [];
  const square = (steps, size, y) => {
    const first = positions.length / 3;
    for (let i = 0; i <= steps; ++i)
      for (let k = 0; k <= steps; ++k) {
        positions.push(size * (k / steps - 0.5), y, size * (i / steps - 0.5));
        normals.push(0, 1, 0);
        if (i === steps || k === steps) continue;
        const [a, b] = [first + i * (steps + 1) + k, first + (i + 1) * (steps + 1) + k];
        indices.push(a, b, a + 1, a + 1, b, b + 1);
      }
  };
  square(40, 4, 0);
  square(4, 0.5, 0.6);
  const count = positions.length / 3;
  const data = Buffer.concat([Buffer.from(new Float32Array([...positions, ...normals]).buffer), Buffer.from(new Uint32Array(indices).buffer)]);
  const bytes = 12 * count;
  const json = {
    asset: { version: "2.0" },
    extensionsUsed: ["KHR_lights_punctual"],
    extensions: { KHR_lights_punctual: { lights } },
    scene: 0,
    scenes: [{ nodes: [0, ...lights.map((_, i) => i + 1)] }],
    nodes: [{ mesh: 0 }, ...lights.map((_, light) => ({ translation: [0.4 - light, 1.2, 0.2], extensions: { KHR_lights_punctual: { light } } }))],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1 }, indices: 2, material: 0 }] }],
    materials: [{ doubleSided: true, pbrMetallicRoughness: { metallicFactor: 0, baseColorFactor: [0.8, 0.7, 0.6, 1] } }],
    accessors: [
      { bufferView: 0, componentType: 5126, count, type: "VEC3", min: [-2, 0, -2], max: [2, 0.6, 2] },
      { bufferView: 1, componentType: 5126, count, type: "VEC3" },
      { bufferView: 2, componentType: 5125, count: indices.length, type: "SCALAR" },
    ],
    bufferViews: [
      { buffer: 0, byteLength: bytes },
      { buffer: 0, byteOffset: bytes, byteLength: bytes },
      { buffer: 0, byteOffset: 2 * bytes, byteLength: 4 * indices.length },
    ],
    buffers: [{ byteLength: data.length, uri: `data:application/octet-stream;base64,${data.toString("base64")}` }],
  };
  writeFileSync(path, JSON.stringify(json));
}

await check("lamps light like prt and can be dimmed", async (page, errors) => {
  const bulb = { type: "point", name: "Bulb", color: [1, 0.9, 0.7], intensity: 2 };
  const red = { type: "point", name: "Red", color: [1, 0.1, 0.05], intensity: 1.5 };
  const prtRun = (...options) => execFileSync(prt, options, { stdio: "ignore" });
  /** Creates a model with these lights, and returns prt's colors at the vertices. */
  const made = (name, lights) => {
    const at = (suffix) => join(work, name + suffix);
    lampScene(at(".gltf"), lights);
    prtRun("bake", at(".gltf"), "-o", at(".baked.glb"), "--rays", "256", "--bounces", "1");
    prtRun("compress", at(".baked.glb"), "-o", at(".glb"), "--bits", "float", "--clusters", "16", "--components", "16");
    prtRun("relight", at(".glb"), "--lights", warmSky, "--env-layout", "lat-long-x", "--suns", "0", "--window", "auto", "--colors", "albedo", "-o", at(".lit.glb"));
    return { file: at(".glb"), colors: vertexColors(at(".lit.glb")) };
  };
  const both = made("both", [bulb, red]);
  const dimmed = made("dimmed", [{ ...bulb, intensity: 0.5 }, { ...red, intensity: 3 }]);
  await onlyWarmSky(page);
  const view = { position: [1.5, 2.5, 3], target: [0, 0.2, 0], fieldOfView: 45 };
  await page.goto(url({ model: "knot", angle: 0, ...query(view), panel: 1 }));
  await picture(page);
  for (const [strengths, { colors }] of [[{}, both], [{ Bulb: 0.25, Red: 2 }, dimmed]]) {
    const before = await page.locator("#model option").count();
    await dropped(page, { "lamps.glb": both.file });
    await page.waitForFunction((n) => document.querySelectorAll("#model option").length > n, before);
    assert.deepEqual(await page.locator("#lamps label").allTextContents(), ["daylight", "Bulb", "Red"]);
    for (const [name, strength] of Object.entries(strengths))
      await page.locator(`#lamps label:has-text("${name}") input`).fill(String(strength));
    if (screenshots) await page.screenshot({ path: join(screenshots, `lamps-${Object.keys(strengths).length}.png`) });
    const d = await radianceAgainst(page, colors);
    console.log(`  ${(100 * d.rms).toFixed(2)} % rms, means ${d.ratio.toFixed(4)} times, over ${(100 * d.even).toFixed(0)} % of the model`);
    assert.ok(d.rms < 0.01 && d.even > 0.2, `${d.rms} over ${d.even}`);
  }
  await page.selectOption("#model", { index: 0 });
  await page.waitForFunction(() => document.querySelector("#lamps").hidden);
  assert.deepEqual(errors, []);
});

await check("suns can be merged into the sky and separated again", async (page, errors) => {
  const view = { ...query(standardCamera), model: "knot", angle: 70 };
  await page.goto(url({ ...view, suns: 1 }));
  await picture(page);
  const separate = await canvas(page);
  let count = await drawn(page);
  await page.evaluate(() => document.querySelector("#suns").click());
  await picture(page, count);
  const together = await canvas(page);
  count = await drawn(page);
  await page.evaluate(() => document.querySelector("#suns").click());
  await picture(page, count);
  assert.ok((await difference(page, separate, await canvas(page))).mean < 0.01);
  assert.ok((await difference(page, separate, together)).mean > 1);
  await page.goto(url({ ...view, suns: 0 }));
  await picture(page);
  assert.ok((await difference(page, together, await canvas(page))).mean < 0.01);
  assert.deepEqual(errors, []);
});

await check("a light file can be dropped with its sky or alone", async (page, errors) => {
  const lightFile = join(work, "warm.json");
  execFileSync(prt, ["project", warmSky, "-o", lightFile, "--env-layout", "lat-long-x", "--suns", "0"], { stdio: "ignore" });
  const light = JSON.parse(readFileSync(lightFile, "utf8"));
  const suns = [{ towards: [0.6, 0.64, 0.48], irradiance: [6, 5, 4], half_angle_radians: 0.005 }];
  writeFileSync(lightFile, JSON.stringify({ ...light, suns }));
  await page.goto(url({ model: "knot", ...query(standardCamera), suns: 1 }));
  await picture(page);
  const names = () => page.locator("#sky option").allTextContents();
  const pictures = [];
  for (const files of [{ "warm.json": lightFile, "warm.hdr": warmSky }, { "warm.json": lightFile }]) {
    const before = (await names()).length;
    const count = await drawn(page);
    await dropped(page, files);
    await page.waitForFunction((n) => document.querySelectorAll("#sky option").length > n, before);
    await picture(page, count);
    assert.equal((await names()).length, before + 1);
    assert.equal((await names()).at(-1), Object.keys(files).at(-1));
    assert.equal(await page.locator("#suns").isDisabled(), false);
    assert.ok(await page.evaluate(() => globalThis.prtkitPicture.sunLights.visible));
    if (screenshots) await page.screenshot({ path: join(screenshots, `light-file-${pictures.length}.png`) });
    // Hides the background: an image, or the few bands of a light file.
    const shown = await drawn(page);
    await page.evaluate(() => {
      globalThis.prtkitPicture.background.visible = false;
      globalThis.prtkitPicture.draw();
    });
    await picture(page, shown);
    pictures.push(await canvas(page));
  }
  const d = await difference(page, ...pictures);
  assert.ok(d.mean < 0.01, `${d.mean}`); // equal light
  await dropped(page, { "warm.hdr": warmSky });
  // an image without a light file has no suns
  await page.waitForFunction(() => document.querySelector("#suns").disabled);
  const notALight = join(work, "notes.json");
  writeFileSync(notALight, "{}");
  await dropped(page, { "notes.json": notALight });
  await page.waitForSelector("#message:not([hidden])");
  assert.match(await page.locator("#message").innerText(), /notes\.json: light file: /);
  assert.deepEqual(errors, []);
});

await check("the light rotates continuously", async (page, errors) => {
  await page.goto(url({ model: "knot" }));
  await picture(page);
  const angle = () => page.evaluate(() => globalThis.prtkitPicture.angle);
  const lightAngle = () => page.evaluate(() => {
    const { position, target } = globalThis.prtkitPicture.sunLights.lights[0];
    return Math.atan2(position.x - target.position.x, position.z - target.position.z);
  });
  const [before, sunBefore] = [await angle(), await lightAngle()];
  await page.locator("#rotating").check();
  await page.waitForFunction((from) => globalThis.prtkitPicture.angle > from + 0.1, before);
  await page.locator("#rotating").uncheck();
  const count = await drawn(page);
  await page.waitForTimeout(300);
  assert.ok((await drawn(page)) <= count + 1, "the rotation continues");
  const rotated = (await lightAngle()) - sunBefore - ((await angle()) - before);
  assert.ok(Math.abs(Math.sin(rotated / 2)) < 1e-6, "suns rotate with the sky");
  assert.deepEqual(errors, []);
});

await check("a figure walks through a model with a volume and casts a shadow; a model without volume shows a message", async (page, errors) => {
  await page.goto(url({ model: "tree", figure: 1, suns: 1, panel: 1 }));
  await page.waitForFunction(() => globalThis.prtkitPicture?.moving.mixer && globalThis.prtkitPicture.moving.metres > 0.1);
  const shown = await page.evaluate(() => {
    const { moving } = globalThis.prtkitPicture;
    moving.group.updateMatrixWorld(true);
    const [foot, ground] = [moving.parts.figure.position, moving.walk.at(moving.metres)];
    let lit = 0;
    moving.parts.figure.traverse(({ material, castShadow }) => (lit += material?._transfer?.model === moving.volume && castShadow ? 1 : 0));
    return { separate: foot.distanceTo(ground), lit, computed: moving.volume.hasLight };
  });
  assert.ok(shown.separate < 1e-6 && shown.lit > 0 && shown.computed, JSON.stringify(shown));
  if (screenshots) await page.screenshot({ path: join(screenshots, "figure.png") });
  // With and without the standing figure: part of the picture differs, and so does the ground in its shadow.
  const still = (figure) =>
    page.evaluate(async (isShown) => {
      const shownPicture = globalThis.prtkitPicture;
      shownPicture.still = true;
      shownPicture.setMoving("figure", isShown);
      const count = shownPicture.drawn;
      while (shownPicture.drawn <= count) await new Promise((next) => setTimeout(next, 20));
      return document.getElementById("view").toDataURL("image/png");
    }, figure);
  const [with_, without] = [await still(true), await still(false)];
  const d = await difference(page, with_, without);
  assert.ok(d.far > 0.002 && d.far < 0.5, `${d.far}`);
  for (const part of ["spheres", "probes"]) await page.locator(`#${part}`).check();
  const probes = await page.evaluate(() => {
    const { volume, parts } = globalThis.prtkitPicture.moving;
    return [volume.probes, ...parts.probes.children.map(({ count }) => count)];
  });
  assert.equal(probes[1] + probes[2], probes[0]);
  assert.ok(probes[2] > 0, "probes below the ground are sealed");
  await page.locator("#model").selectOption({ label: "knot" });
  await page.waitForSelector("#moving:disabled");
  assert.match(await page.locator("#unmoving").innerText(), /no volume/);
  assert.equal(await page.evaluate(() => globalThis.prtkitPicture.moving.isWalking), false);
  assert.deepEqual(errors, []);
});

await check("on a phone the panel does not cover the model", async (page, errors) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await page.goto(url({ model: "knot" }));
  await picture(page);
  for (const open of [false, true]) {
    await page.evaluate((value) => (document.querySelector("#panel").open = value), open);
    await page.waitForTimeout(200);
    const [panel, view] = [await page.locator("#panel").boundingBox(), await page.locator("#view").boundingBox()];
    assert.ok(panel.y >= view.y + view.height - 1, "the panel covers the picture");
    assert.ok(view.height > (open ? 0.5 : 0.9) * 844 && view.width === 390, `the picture has ${view.width} x ${view.height}`);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    // The drawing has the shape of its element, and all corners of the model are in it.
    const outside = await page.evaluate(() => {
      const { camera, gltf, renderer } = globalThis.prtkitPicture;
      const canvasShape = renderer.domElement.width / renderer.domElement.height;
      let most = Math.abs(canvasShape / camera.aspect - 1) > 0.01 ? 9 : 0;
      gltf.scene.traverse((object) => {
        if (!object.isMesh) return;
        const { min, max } = object.geometry.boundingBox;
        for (let corner = 0; corner < 8; ++corner) {
          const p = min.clone().set(corner & 1 ? min.x : max.x, corner & 2 ? min.y : max.y, corner & 4 ? min.z : max.z);
          p.applyMatrix4(object.matrixWorld).project(camera);
          most = Math.max(most, Math.abs(p.x), Math.abs(p.y));
        }
      });
      return most;
    });
    assert.ok(outside <= 1, `the model reaches ${outside} times the edge of the picture`);
    if (screenshots) await page.screenshot({ path: join(screenshots, `phone-${open ? "open" : "closed"}.png`) });
  }
  assert.deepEqual(errors, []);
});

await check("the page shows what it is loading", async (page) => {
  let release;
  const held = new Promise((resolve) => (release = resolve));
  await page.route("**/*.glb", async (route) => {
    await held;
    await route.continue();
  });
  await page.addInitScript(() => {
    globalThis.shares = [];
    const look = () => {
      const bar = document.getElementById("share");
      if (bar?.checkVisibility()) globalThis.shares.push(bar.value);
      requestAnimationFrame(look);
    };
    look();
  });
  await page.goto(url({ model: "knot" }));
  await page.waitForFunction(() => /knot/.test(document.querySelector("#loading:not([hidden])")?.innerText ?? ""));
  release();
  await picture(page);
  await page.waitForSelector("#loading", { state: "hidden" });
  const shares = await page.evaluate(() => globalThis.shares);
  assert.ok(shares[0] === 0 && Math.max(...shares) > 0.4, `the bar is at ${[...new Set(shares)]}`);
});

await check("the models before and after compression are shown side by side", async (page, errors) => {
  const view = { model: "knot", quality: 0, angle: 30, ...query(standardCamera) };
  const shownAt = async (more) => {
    await page.goto(url({ ...view, ...more }));
    await picture(page);
    await page.waitForSelector("#loading", { state: "hidden" });
    const count = await drawn(page);
    await page.evaluate(() => globalThis.prtkitPicture.draw());
    await picture(page, count);
    return canvas(page);
  };
  const after = await shownAt({});
  assert.ok((await difference(page, after, await shownAt({ split: 0 }))).mean < 0.01);
  const before = await shownAt({ split: 1 });
  if (screenshots) await page.screenshot({ path: join(screenshots, "compare.png") });
  const separate = (await difference(page, after, before)).mean;
  const d = await difference(page, before, await render(page, models[0].before.file, 30, standardCamera));
  const half = await difference(page, before, await shownAt({ split: 0.5 }));
  console.log(`  before and after ${separate.toFixed(3)} of 255, half of each ${half.mean.toFixed(3)}`);
  assert.ok(separate > 0.05 && half.mean > 0.2 * separate && half.mean < 0.8 * separate, `${half.mean} of ${separate}`);
  assert.ok(d.mean < MEAN_TOLERANCE, `mean difference ${d.mean}`);
  assert.deepEqual(errors, []);
});

await check("the address links to the current view", async (page, errors) => {
  await page.goto(url({ model: "tree", panel: 1 }));
  await picture(page);
  await page.waitForSelector("#loading", { state: "hidden" });
  const before = await canvas(page);
  await page.selectOption("#quality", { index: 1 });
  await page.selectOption("#window", { index: 2 });
  await page.locator("#suns").uncheck();
  await page.locator("#shine").check();
  await page.locator("#angle").fill("77");
  await page.locator("#exposure").fill("-1");
  await page.evaluate(() => {
    globalThis.prtkitPicture.controls.object.position.x += 1;
    globalThis.prtkitPicture.controls.update();
    globalThis.prtkitPicture.controls.dispatchEvent({ type: "end" });
  });
  await page.waitForFunction(() => /shine=1/.test(location.search) && /angle=77/.test(location.search) && /exposure=-1/.test(location.search));
  await page.waitForTimeout(1000);
  const [address, shown] = [await page.evaluate(() => location.href), await canvas(page)];
  await page.goto("about:blank");
  await page.goto(address);
  await picture(page);
  await page.waitForSelector("#loading", { state: "hidden" });
  await page.waitForTimeout(1000);
  assert.ok((await difference(page, shown, await canvas(page))).mean < 0.1, address);
  assert.ok((await difference(page, shown, before)).mean > 1);
  assert.deepEqual(errors, []);
});

await check("a missing model shows a message", async (page) => {
  await page.route("**/*.glb", (route) => route.fulfill({ status: 404, body: "" }));
  await page.goto(url({ model: "knot" }));
  await page.waitForSelector("#message:not([hidden])");
});

await check("a model without transfer shows a message", async (page) => {
  const json = JSON.stringify({ asset: { version: "2.0" }, scenes: [{ nodes: [] }], scene: 0 });
  const text = Buffer.from(json.padEnd(Math.ceil(json.length / 4) * 4));
  const head = Buffer.alloc(20);
  head.write("glTF");
  [2, 20 + text.length, text.length].forEach((value, i) => head.writeUInt32LE(value, 4 + 4 * i));
  head.write("JSON", 16);
  await page.route("**/*.glb", (route) => route.fulfill({ body: Buffer.concat([head, text]) }));
  await page.goto(url({ model: "knot" }));
  await page.waitForSelector("#message:not([hidden])");
  assert.match(await page.locator("#message").innerText(), /has no transfer.*prt bake/);
});

await check("a model with lightmaps can be dropped, also on a phone", async (page, errors) => {
  await page.setViewportSize({ width: 390, height: 844 });
  const lightmaps = join(work, "lightmaps.glb");
  writeFileSync(lightmaps, bakedModel("texels"));
  await page.goto(url({ model: "knot", suns: 0 }));
  await picture(page);
  const count = await drawn(page);
  await dropped(page, { "lightmaps.glb": lightmaps });
  await page.waitForFunction(() => document.querySelector("#model").selectedOptions[0].text === "lightmaps.glb");
  await picture(page, count);
  await page.locator("#panel summary").click();
  const [names, values] = await Promise.all(["dt", "dd"].map((part) => page.locator(`#figures ${part}`).allInnerTexts()));
  assert.deepEqual(names.slice(0, 2), ["texels", "bytes per texel"]);
  assert.deepEqual(values.slice(0, 2), ["8,384", "8"]);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 390), "the page is not wider than the screen");
  if (screenshots) await page.screenshot({ path: join(screenshots, "phone-lightmaps.png") });
  const before = await canvas(page);
  const next = await drawn(page);
  await page.evaluate(() => globalThis.prtkitPicture.setAngle(2));
  await picture(page, next);
  assert.ok((await difference(page, before, await canvas(page))).mean > 0.3, "light rotates");
  assert.deepEqual(errors, []);
});

await check("lightmaps of prt: the picture equals that of prt render", async (page, errors) => {
  const [scene, baked, shipped] = ["scene", "baked", "shipped"].map((name) => join(work, `${name}.glb`));
  writeFileSync(scene, bakedModel("vertices", (json) => {
    delete json.extensions;
    // Only three renders coats and metals.
    json.materials = json.materials.map(({ extensions: _, pbrMetallicRoughness, ...material }) => ({
      ...material,
      pbrMetallicRoughness: { ...pbrMetallicRoughness, metallicFactor: 0 },
    }));
    for (const { primitives } of json.meshes)
      for (const name of Object.keys(primitives[0].attributes)) if (name.startsWith("_PRT")) delete primitives[0].attributes[name];
  }));
  const run = (...options) => execFileSync(prt, options, { stdio: "ignore" });
  run("bake", scene, "-o", baked, "--rays", "256", "--bounces", "1", "--texels", "128", "--texels", "unwrap");
  run("compress", baked, "-o", shipped);
  const view = { position: [1.5, 3, 5], target: [0, 0.4, 0], fieldOfView: 40 };
  await page.goto(url({ model: "knot", angle: 60, panel: 0, suns: 0 }));
  await picture(page);
  const count = await drawn(page);
  await dropped(page, { "shipped.glb": shipped });
  await page.waitForFunction(() => document.querySelector("#model").selectedOptions[0].text === "shipped.glb");
  await page.evaluate((camera) => {
    globalThis.prtkitPicture.frame(camera);
    globalThis.prtkitPicture.draw();
  }, view);
  await picture(page, count + 1);
  const [shown, expected] = [await canvas(page), await render(page, relative(distFolder, shipped), 60, view)];
  const d = await difference(page, shown, expected);
  if (screenshots) {
    writeFileSync(join(screenshots, "lightmaps.png"), Buffer.from(shown.split(",")[1], "base64"));
    writeFileSync(join(screenshots, "lightmaps.prt.png"), Buffer.from(expected.split(",")[1], "base64"));
  }
  console.log(`  mean ${d.mean.toFixed(3)} of 255, ${(100 * d.far).toFixed(2)} % of the pixels differ by more than ${FAR}`);
  assert.deepEqual(errors, []);
  assert.ok(d.mean < MEAN_TOLERANCE, `mean difference ${d.mean}`);
  assert.ok(d.far < FAR_SHARE, `${d.far} of the pixels differ`);
});

for (const by of ["vertices", "texels"])
  await check(`a raw bake of ${by} shows the command that compresses it`, async (page) => {
    const raw = join(work, "raw.glb");
    writeFileSync(raw, bakedModel(by, (json) => (setIn(json, by).coding = "raw")));
    await page.goto(url({ model: "knot" }));
    await picture(page);
    await dropped(page, { "raw.glb": raw });
    await page.waitForSelector("#message:not([hidden])");
    assert.match(await page.locator("#message").innerText(), new RegExp(`^raw.glb: PRTKIT_transfer: ${by}: .*prt compress baked.glb -o shipped.glb`));
  });

await browser.close();
server.httpServer.close();
rmSync(work, { recursive: true });
console.log(`${checked} checks, ${failed} failed`);
process.exit(failed === 0 && checked > 0 ? 0 : 1);
