// Puts pictures side by side, in COLUMNS of WIDTH pixels (0: as they are), by Chromium; .png or .jpg by name.
//   node sheet.mjs OUTPUT COLUMNS WIDTH PICTURE...
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const { chromium } = createRequire(new URL("../../examples/web/package.json", import.meta.url))("playwright-core");
const [output, columns, width, ...pictures] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
const page = await browser.newPage({ viewport: { width: 4000, height: 100 } });
const size = Number(width) > 0 ? `width="${width}"` : "";
const images = pictures.map(
  (file) => `<img ${size} style="display: block" src="data:image/png;base64,${readFileSync(file).toString("base64")}">`,
);
const gap = images.length > 1 ? 6 : 0;
await page.setContent(
  `<body style="margin: 0"><div id="sheet" style="display: inline-grid; grid-template-columns: repeat(${columns}, auto);
   gap: ${gap}px; background: white">${images.join("")}</div>`,
);
const jpeg = output.endsWith(".jpg") ? { type: "jpeg", quality: 88 } : { type: "png" };
await page.locator("#sheet").screenshot({ path: output, ...jpeg });
await browser.close();
