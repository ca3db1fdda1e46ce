// Makes the page's models with prt: public/models/ and public/skies/. Uses the example scenes and sky;
// add others with
//   npm run models -- scene.glb sky.hdr
// PRT_RAYS, PRT_SCENES (knot,tree) and PRT_QUALITIES (small,normal,fine,before) reduce the work for tests. An interrupted run continues: bakes stay in
// work/ until all models are done. prt and example_scenes are those of build/release (./demo.sh builds them),
// or in PRT and PRT_EXAMPLE_SCENES.
import { execFileSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { basename, extname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { publicFolder, workFolder as work } from "./folders.mjs";

const root = fileURLToPath(new URL("../../../", import.meta.url));
const prt = process.env.PRT ?? join(root, "build/release/cli/prt");
const exampleScenes = process.env.PRT_EXAMPLE_SCENES ?? join(root, "build/release/examples/scenes/example_scenes");
const rays = process.env.PRT_RAYS ?? "1024";
const extra = process.argv.slice(2);
const manifest = join(publicFolder, "models/models.json");

if (existsSync(manifest) && extra.length === 0) process.exit(0); // already made
for (const program of [prt, exampleScenes])
  if (!existsSync(program)) {
    console.error(`make-models: error: ${program}: does not exist; run ./demo.sh, or set PRT and PRT_EXAMPLE_SCENES`);
    process.exit(1);
  }

const run = (program, ...options) => execFileSync(program, options, { stdio: ["ignore", "ignore", "inherit"] });
mkdirSync(work, { recursive: true });
mkdirSync(join(publicFolder, "models"), { recursive: true });
mkdirSync(join(publicFolder, "skies"), { recursive: true });
// forest:2000 is a forest of 2000 trees.
const specs = process.env.PRT_SCENES?.split(",") ?? ["knot", "room", "tree", "terrain", "night_room", "courtyard", "forest:2000", "figure"];
const names = specs.map((spec) => spec.split(":")[0]);
const times = process.env.PRT_SCENES ? [] : ["noon", "evening", "night"]; // for models with lamps
if (!existsSync(join(work, "sky.exr"))) run(exampleScenes, work, ...specs, ...(names.includes("figure") ? [] : ["figure"]), ...times, "sky"); // the sky is written last

const qualities = process.env.PRT_QUALITIES?.split(",");
const isWanted = (title) => qualities?.includes(title) ?? true;
const levels = [
  { name: "u32", title: "small", options: ["--preset", "u32"] },
  { name: "u64", title: "normal", options: ["--preset", "u64"] },
  { name: "u128", title: "fine", options: ["--clusters", "64", "--components", "16", "--bits", "122"] }, // four words with the cluster
].filter(({ title }) => isWanted(title));
/** Options of a model close to the bake: the maximum number of components of a shader, without rounding. */
const asBaked = ["--bits", "float", "--clusters", "16", "--components", "48", "--predictors", "none", "--seam-weight", "0"];
const cameras = {
  room: { position: [1.2, 1.9, 4.2], target: [0, 1.8, -5], fieldOfView: 45 },
  tree: { position: [1.5, 1.7, 5.5], target: [0, 1.9, 0] },
  terrain: { position: [1, 4.5, 11], target: [0, 2.6, 0] },
  night_room: { position: [0.6, 1.7, 2.6], target: [0, 1.8, -6], fieldOfView: 50 },
  courtyard: { position: [3.9, 1.75, 4.9], target: [-1.3, 2.75, -6], fieldOfView: 46 },
  forest: { position: [13, 12, 34], target: [0, 2, 0] },
  figure: { position: [1.3, 1.7, 3.4], target: [0, 0.95, 0] },
};
/** Paths of the walking figure, and distance between the probes of the volume there, in metres. */
const walks = {
  room: { spacing: 0.5, way: { points: [[0, -1.2], [0.9, -3.5], [0.4, -7.8], [-0.4, -8.6], [-1, -5.5], [-0.6, -2.2]], from: 2 } },
  tree: { spacing: 0.5, way: { points: [[1.9, 1.6], [0, 2.2], [-1.9, 1.4], [-1.6, -1.6], [1.6, -1.7]], from: 1 } },
  terrain: { spacing: 0.75, way: { points: [[3.5, 2.5], [0.5, 4], [-3.4, 2.2], [-3.6, -2], [0, -3.6], [3.6, -2]], from: 9 } },
  night_room: { spacing: 0.5, way: { points: [[0, -1.2], [0.9, -3.5], [0.4, -7.2], [-0.4, -7.4], [-0.9, -4.8], [-0.6, -2.2]], from: 2 } },
  courtyard: { spacing: 1, way: { points: [[2.6, 0.5], [1.6, -4.4], [-1.8, -4.8], [-3, 0], [-0.5, 3]], from: 2 } },
};
const large = new Set(["courtyard", "forest"]); // fewer rays and one file, because all would take an hour
/**
 * Models whose instances share transfer, in few clusters, because each instance has constants for all
 * clusters of its mesh.
 */
const shared = {
  forest: { bake: ["--instances", "shared", "--instances", "error=1"], level: { name: "u32", title: "small", options: ["--clusters", "48"] } },
};
/** Skinned models have no bake of one pose, but lobes for all poses of the animation shown. */
const dancing = { figure: "dance" };
const scenes = names.filter((name) => !dancing[name]).map((name) => ({ name, file: join(work, `${name}.glb`) }));
// The example sky has OpenEXR's layout; skies of users have three's layout.
const skies = [{ title: "clear day", file: join(work, "sky.exr"), center: "z" }];
for (const title of times) skies.push({ title, file: join(work, `${title}.exr`), center: "z" });
for (const path of extra) {
  const title = basename(path, extname(path));
  if ([".glb", ".gltf"].includes(extname(path))) scenes.push({ name: title, file: path });
  else skies.push({ title, file: path });
}

const isNewer = (made, from) => existsSync(made) && statSync(made).mtimeMs >= statSync(from).mtimeMs;

const models = scenes.map(({ name, file }, i) => {
  const count = large.has(name) ? Math.min(256, Number(rays)) : rays;
  const baked = join(work, `${name}.${count}.baked.glb`);
  if (!isNewer(baked, file)) {
    console.log(`baking ${name} (${i + 1} of ${scenes.length})`);
    const volume = walks[name] ? ["--volume", String(walks[name].spacing)] : [];
    const sharing = shared[name]?.bake ?? [];
    run(prt, "bake", file, "-o", baked, "--bounces", "3", "--rays", String(count), "--lamps", "rays=32", ...volume, ...sharing);
  }
  console.log(`compressing ${name} (${i + 1} of ${scenes.length})`);
  const compressed = (suffix, options) => {
    const shipped = `models/${name}.${suffix}.glb`;
    const json = join(work, "compress.json");
    run(prt, "compress", baked, "-o", join(publicFolder, shipped), "--meshopt", "--json", json, ...options);
    const figures = JSON.parse(readFileSync(json, "utf8"));
    return {
      file: shipped,
      fileBytes: statSync(join(publicFolder, shipped)).size,
      bytesPerVertexWithBases: figures.bytes_bound_per_vertex_with_bases,
      litRms: figures.lit_rms,
    };
  };
  const before = large.has(name) || !isWanted("before") ? undefined : compressed("baked", asBaked);
  return {
    name,
    title: name,
    camera: cameras[name],
    way: walks[name]?.way,
    ...(shared[name] ? { shares: true } : {}),
    before: before && { file: before.file, bytes: Math.round(before.bytesPerVertexWithBases), litRms: before.litRms },
    levels: (shared[name] ? [shared[name].level] : levels)
      .filter((level) => shared[name] || !large.has(name) || level.name === "u64")
      .map((level) => ({ title: level.title, ...compressed(level.name, level.options) })),
  };
});
for (const [name, clip] of Object.entries(dancing)) {
  if (!names.includes(name)) continue;
  console.log(`fitting lobes to ${name}`);
  const file = `models/${name}.lobes.glb`;
  run(prt, "lobes", join(work, `${name}.glb`), "-o", join(publicFolder, file), "--rays", rays, "--poses", "frames=0");
  const level = { title: "lobes", file, fileBytes: statSync(join(publicFolder, file)).size };
  models.push({ name, title: `${name}, dancing`, camera: cameras[name], clip, levels: [level] });
}
// Light files have all bands, for models of any order.
const skyEntries = skies.map(({ title, file, center = "x" }) => {
  const to = `skies/${basename(file)}`;
  const light = `${to}.json`;
  copyFileSync(file, join(publicFolder, to));
  run(prt, "project", file, "-o", join(publicFolder, light), "--suns", "auto", "--order", "10", "--env-layout", center === "x" ? "lat-long-x" : "lat-long");
  return { title, file: to, center, light };
});
const figure = "models/figure.glb";
run(prt, "ao", join(work, "figure.glb"), "-o", join(publicFolder, figure), "--occluders");
writeFileSync(manifest, JSON.stringify({ models, skies: skyEntries, figure }, null, 2));
rmSync(work, { recursive: true });
console.log(`${publicFolder}: models and skies are complete`);
