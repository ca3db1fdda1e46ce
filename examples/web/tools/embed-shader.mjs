// Makes GLSL JavaScript modules, with what it includes: those of shaders/, of which there is one source, and what stands in
// src/.
import { readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const root = new URL("../../../", import.meta.url);

function embed(folder, name) {
  const resolve = (file) =>
    readFileSync(new URL(folder + file, root), "utf8").replace(/^#include "(.+)"$/gm, (_, included) => resolve(included));
  writeFileSync(
    fileURLToPath(new URL(`../src/${name}.js`, import.meta.url)),
    `// Made from ${folder}${name} by tools/embed-shader.mjs.\nexport default ${JSON.stringify(resolve(name))};\n`,
  );
}

for (const name of ["prt_exit_radiance.glsl", "prt_lightmap.frag"]) embed("shaders/", name);
for (const name of ["sunLight", "sunLoop", "transferVertex"]) embed("examples/web/src/", `${name}.glsl`);
