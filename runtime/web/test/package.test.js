// Tests the installed result of `npm pack`. installed.mjs draws with it.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { test } from "node:test";

const web = fileURLToPath(new URL("../", import.meta.url));
const { exports, files: listed } = JSON.parse(readFileSync(join(web, "package.json"), "utf8"));

/** Returns the paths in the package that a module imports or starts as a worker. */
function importsOf(path) {
  const text = readFileSync(join(web, path), "utf8");
  const found = [...text.matchAll(/(?:from|import)\s*\(?\s*"(\.[^"]+)"|new URL\("(\.[^"]+)", import\.meta\.url\)/g)];
  return found.map(([, imported, url]) => normalize(join(dirname(path), imported ?? url)).replaceAll("\\", "/"));
}

test("the package contains exactly the files that its modules import", () => {
  const reached = new Set();
  const visit = (path) => {
    if (reached.has(path)) return;
    reached.add(path);
    importsOf(path).forEach(visit);
  };
  visit(normalize(exports["."].default));
  const ofWebgl = [...reached].map((path) => readFileSync(join(web, path), "utf8"));
  assert.ok(ofWebgl.every((text) => !/from "three\/(webgpu|tsl)"/.test(text)), "WebGL does not need nodes");
  visit(normalize(exports["./webgpu"].default));
  assert.ok(reached.has("src/projectionWorker.js"), "workers are found");
  assert.deepEqual(listed.filter((path) => !path.endsWith(".d.ts")).sort(), [...reached].sort());
  for (const entry of [".", "./webgpu"]) assert.ok(listed.includes(normalize(exports[entry].types)));
});

test("the installed package loads and is small", () => {
  const folder = mkdtempSync(join(tmpdir(), "prtkit-package-"));
  try {
    const npm = (...options) => execFileSync("npm", options, { cwd: folder, encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] });
    const [{ filename, files, size }] = JSON.parse(npm("pack", web, "--json", "--ignore-scripts"));
    // The package excludes the page, the tests and the models.
    assert.deepEqual(files.map(({ path }) => path).sort(), [...listed, "README.md", "package.json"].sort());
    assert.ok(size < 95_000, `${size} bytes`);
    writeFileSync(join(folder, "package.json"), JSON.stringify({ name: "game", version: "1.0.0", type: "module" }));
    npm("install", "--offline", "--legacy-peer-deps", "--no-audit", "--no-fund", `./${filename}`);
    mkdirSync(join(folder, "node_modules"), { recursive: true });
    symlinkSync(join(web, "node_modules/three"), join(folder, "node_modules/three"), "dir"); // of the game
    const names = [...readFileSync(join(web, exports["."].types), "utf8").matchAll(/^export (?:class|function|const) (\w+)/gm)].map(([, name]) => name);
    assert.ok(names.includes("PrtkitPlugin"));
    writeFileSync(
      join(folder, "game.js"),
      `import * as prtkit from "prtkit-web";
       console.log(Object.keys(prtkit).sort().join());
       const nodes = await import("prtkit-web/webgpu");
       console.log(Object.keys(nodes).sort().join(), nodes.PrtkitPlugin !== prtkit.PrtkitPlugin);`,
    );
    const expected = names.sort().join();
    assert.equal(execFileSync("node", ["game.js"], { cwd: folder, encoding: "utf8" }), `${expected}\n${expected} true\n`);
  } finally {
    rmSync(folder, { recursive: true });
  }
});
