// Converts GLSL to JavaScript modules, with includes and without comments: files of shaders/, the only
// source, and of src/.
import { readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const root = new URL("../../../", import.meta.url);
const runtime = ["prt_exit_radiance.glsl", "prt_instances.glsl", "prt_lightmap.frag", "prt_lobes.glsl", "prt_occluders.glsl", "prt_volume.glsl"];

/** Removes comments: they are for readers of shaders/, and browsers load the modules. */
const bare = (text) => text.replace(/[ \t]*\/\/.*$/gm, "").replace(/\n\s+/g, "\n").trimStart();

/** Writes a module. An included file that is a module is imported, so that it exists once. */
function embed(folder, name) {
  const imports = [];
  const resolve = (file) =>
    bare(readFileSync(new URL(folder + file, root), "utf8")).replace(/^#include "(.+)"$/gm, (_, included) => {
      if (!runtime.includes(included)) return resolve(included);
      imports.push(included);
      return `\0${imports.length - 1}\0`;
    });
  const pieces = resolve(name).split("\0").map((piece, i) => (i % 2 === 0 ? JSON.stringify(piece) : `included${piece}`));
  const lines = imports.map((included, i) => `import included${i} from "./${included}.js";\n`);
  writeFileSync(
    fileURLToPath(new URL(`../src/${name}.js`, import.meta.url)),
    `// Made from ${folder}${name} by tools/embed-shader.mjs.\n${lines.join("")}export default ${pieces.join(" + ")};\n`,
  );
}

for (const name of runtime) embed("shaders/", name);
for (const name of ["sunLight", "sunLoop", "transferVertex", "volumeLight"]) embed("runtime/web/src/", `${name}.glsl`);
