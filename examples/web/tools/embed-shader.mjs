// Makes shaders/prt_exit_radiance.glsl, with what it includes, a JavaScript module: there is one source of it.
import { readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const shaders = new URL("../../../shaders/", import.meta.url);
const resolve = (name) =>
  readFileSync(new URL(name, shaders), "utf8").replace(/^#include "(.+)"$/gm, (_, included) => resolve(included));

const text = resolve("prt_exit_radiance.glsl");
writeFileSync(
  fileURLToPath(new URL("../src/prt_exit_radiance.glsl.js", import.meta.url)),
  `// Made from shaders/prt_exit_radiance.glsl by tools/embed-shader.mjs.\nexport default ${JSON.stringify(text)};\n`,
);
