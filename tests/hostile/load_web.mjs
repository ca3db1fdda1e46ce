// Tests the plug-in of runtime/web with damaged shipped files:
//   node load_web.mjs FOLDER [verbose]
// three's GLTFLoader loads every FOLDER/*.glb with the plug-in: an Error with the reason rejects it, or its
// light is finite, in bounded time. FOLDER/whole.*.glb are valid and must be read. Prints all violations, and
// then exits with status 1.
import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const web = join(dirname(fileURLToPath(import.meta.url)), "../../runtime/web");
const require = createRequire(join(web, "package.json"));
const module = (name) => import(pathToFileURL(require.resolve(name)).href);
const { GLTFLoader } = await module("three/examples/jsm/loaders/GLTFLoader.js");
const { DataTexture, FloatType, RGBAFormat } = await module("three");
const { PrtkitPlugin, PrtkitVolume, projectEquirectangular } = await import(pathToFileURL(join(web, "src/PrtkitLoader.js")).href);

const [folder, verbose] = process.argv.slice(2);
const white = projectEquirectangular(new DataTexture(new Float32Array([1, 1, 1, 1]), 1, 1, RGBAFormat, FloatType));
globalThis.createImageBitmap ??= async () => ({}); // node cannot decode images
const SECONDS = 20; // normal files need milliseconds

/** Returns the first error of a volume; null if it is valid. */
function wrongVolume(volume) {
  const floats = new PrtkitVolume(volume.source, volume.root, volume.plugin, { floats: true });
  floats.setLight(white.deringed(), 0.3);
  floats.settle();
  const words = [volume.texture, ...["visibility", "index"].map((name) => volume.uniforms[`prt_volume_${name}`].value)];
  if (words.some(({ image: { data, width, height, depth } }) => data.length < width * height * depth)) return "a texture is too short";
  return floats.texture.image.data.every(Number.isFinite) ? null : "the light of probes is not finite";
}

/** Returns the first error of a model that was read; null if it is valid. */
function wrongModel(gltf) {
  const model = gltf.userData.prtkit;
  if (!model) return null;
  const wrongProbes = model.volume ? wrongVolume(model.volume) : null;
  if (wrongProbes || model === model.volume) return wrongProbes;
  model.setLight(white.deringed(), 0.3);
  const { clusters, constantsTexture } = model;
  if (!constantsTexture.image.data.every(Number.isFinite)) return "constants are not finite";
  let wrong = null;
  gltf.scene.traverse(({ geometry }) => {
    const attributes = geometry?.attributes ?? {};
    for (const name of ["prt_baked_position", "prt_baked_normal", "prt_weights_0", "prt_weights_1"])
      if (attributes[name] && !Array.from(attributes[name].array).every(Number.isFinite)) wrong = `${name} is not finite`;
    const words = attributes.prt_words_0 ?? attributes.prt_cluster;
    const mask = clusters.widths ? 2 ** clusters.clusterBits - 1 : 0xffffffff;
    for (let v = 0; words && v < words.count; ++v)
      if ((words.getX(v) & mask) >>> 0 >= clusters.components.length) wrong = `vertex ${v} names a cluster that does not exist`;
  });
  return wrong;
}

/** Returns what is wrong with a rejection by `error`, or null. */
function wrongRefusal(error) {
  if (!(error instanceof Error)) return "throws a value that is not an Error";
  const inOurs = /examples\/web\/src/.test(error.stack.split("\n").find((line) => line.trim().startsWith("at ")) ?? "");
  const ours = /^PRTKIT_(transfer|occlusion_volume): [^\n]+$/.test(error.message);
  return inOurs && !ours ? `throws ${error.name}: ${error.message}` : null;
}

process.on("unhandledRejection", () => {}); // GLTFLoader leaves some unhandled when it fails
let read = 0;
let findings = 0;
const files = readdirSync(folder).filter((name) => name.endsWith(".glb"));
for (const name of files) {
  const bytes = readFileSync(join(folder, name));
  const begin = performance.now();
  let wrong = null;
  try {
    const loader = new GLTFLoader().register((parser) => new PrtkitPlugin(parser));
    wrong = wrongModel(await loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), ""));
    ++read;
  } catch (error) {
    wrong = name.startsWith("whole") ? `is rejected: ${error}` : wrongRefusal(error);
    if (wrong && verbose) wrong += `\n${error.stack}`;
  }
  if (performance.now() - begin > 1000 * SECONDS) wrong = "takes too long";
  if (wrong) {
    ++findings;
    console.log(`${name}: ${wrong}`);
  }
}
console.log(`${files.length} files, ${read} read, ${findings} findings`);
process.exitCode = findings > 0 ? 1 : 0;
