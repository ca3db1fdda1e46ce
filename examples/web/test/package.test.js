// What `npm pack` makes, installed elsewhere.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { test } from "node:test";

const web = fileURLToPath(new URL("../", import.meta.url));

test("the package loads where it is installed", () => {
  const folder = mkdtempSync(join(tmpdir(), "prtkit-package-"));
  try {
    const npm = (...options) => execFileSync("npm", options, { cwd: folder, encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] });
    const [{ filename, files }] = JSON.parse(npm("pack", web, "--json", "--ignore-scripts"));
    // Without the page, the tests and the models.
    for (const { path } of files) assert.match(path, /^(src\/\w+(\.\w+)*\.(js|d\.ts)|package\.json|README\.md)$/);
    writeFileSync(join(folder, "package.json"), JSON.stringify({ name: "game", version: "1.0.0", type: "module" }));
    npm("install", "--offline", "--legacy-peer-deps", "--no-audit", "--no-fund", `./${filename}`);
    mkdirSync(join(folder, "node_modules"), { recursive: true });
    symlinkSync(join(web, "node_modules/three"), join(folder, "node_modules/three"), "dir"); // the game's own
    writeFileSync(
      join(folder, "game.js"),
      `import * as prtkit from "prtkit-web";
       const names = ["PrtkitPlugin", "projectEquirectangular", "halfFloatSky", "ShLight", "SunLights", "readLightFile", "lightOfSuns"];
       console.log(names.map((name) => prtkit[name]).every((f) => typeof f === "function"));`,
    );
    assert.equal(execFileSync("node", ["game.js"], { cwd: folder, encoding: "utf8" }), "true\n");
  } finally {
    rmSync(folder, { recursive: true });
  }
});
