// Takes a picture of the built page in headless Chromium.
//   node tools/screenshot.mjs OUTPUT.png [QUERY] [WIDTHxHEIGHT]
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { preview } from "vite";

const [output, query = "", size = "1000x600"] = process.argv.slice(2);
const [width, height] = size.split("x").map(Number);
const server = await preview({
  root: fileURLToPath(new URL("../", import.meta.url)),
  preview: { port: 0, host: "127.0.0.1" },
  logLevel: "error",
});
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const page = await browser.newPage({ viewport: { width, height } });
await page.goto(`http://127.0.0.1:${server.httpServer.address().port}/${query}`);
await page.waitForFunction(() => globalThis.prtkitPicture?.drawn > 0, null, { timeout: 60000 });
await page.waitForTimeout(500);
await page.screenshot({ path: output });
await browser.close();
server.httpServer.close();
