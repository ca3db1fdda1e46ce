// Milliseconds from the start of loading the page to its first picture, in headless Chromium; not a test.
//   npm run build && node test/first_picture.mjs MODEL.glb [runs]
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { preview } from "vite";

const [file, runs = 5] = process.argv.slice(2);
const model = readFileSync(file);
const server = await preview({
  root: fileURLToPath(new URL("../", import.meta.url)),
  preview: { port: 0, host: "127.0.0.1" },
  logLevel: "error",
});
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--no-first-run"],
});
const times = [];
for (let run = 0; run < runs; ++run) {
  const page = await browser.newPage({ viewport: { width: 640, height: 360 } });
  await page.route("**/*.glb", (route) => route.fulfill({ body: model }));
  await page.goto(`http://127.0.0.1:${server.httpServer.address().port}/`);
  await page.waitForFunction(() => globalThis.prtkitPicture?.drawn > 0, null, { polling: "raf", timeout: 60000 });
  times.push(await page.evaluate(() => performance.now()));
  await page.close();
}
times.sort((a, b) => a - b);
console.log(`${file}: ${(model.length / 1e6).toFixed(2)} MB, first picture after ${times.map((t) => Math.round(t)).join(", ")} ms`);
await browser.close();
server.httpServer.close();
process.exit(0);
