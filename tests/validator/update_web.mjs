// Compares the textures of runtime/web for a volume with those of the runtime:
//   node update_web.mjs SHIPPED TEXTURES
// TEXTURES contains words of visibility distances and of the index, and bits of half floats of light, one
// after the other, under a sky of coefficients cos(1), cos(2), .. and suns half as strong towards +Y. Prints
// the differences, and then exits with status 1. Half floats may differ by one step: the order of sums
// differs.
import { readFileSync } from "node:fs";
import { lightColumns } from "../../runtime/web/src/clusteredPca.js";
import { halfFloat } from "../../runtime/web/src/halfFloat.js";
import { VolumeRelighter } from "../../runtime/web/src/VolumeRelighter.js";
import { atlasOf, indexTexels, visibilityTexels } from "../../runtime/web/src/volumeTextures.js";
import { volumeOf } from "../../runtime/web/src/volumeTransfer.js";
import { setsOf } from "../../runtime/web/src/wholeExtension.js";

const file = readFileSync(process.argv[2]);
const length = file.readUInt32LE(12);
const json = JSON.parse(file.subarray(20, 20 + length).toString("utf8"));
const view = (i) => {
  const { byteOffset = 0, byteLength } = json.bufferViews[i];
  return new Uint8Array(file.subarray(28 + length + byteOffset, 28 + length + byteOffset + byteLength));
};
const volume = volumeOf(setsOf(json).probes, view);
const { grid, visibility, order, clusters } = volume;
const atlas = atlasOf(grid, order);
const sky = Array.from({ length: 3 * clusters.order ** 2 }, (_, i) => Math.cos(i + 1));
const relighter = new VolumeRelighter(volume, atlas);
relighter.updateConstants(lightColumns(clusters, sky, sky.map((value) => value / 2)), [0, 1, 0], 0, clusters.components.length);
const light = new Uint16Array(4 * atlas.texels * atlas.planes);
relighter.update(0, relighter.probes, light);

const bytes = new Uint8Array(readFileSync(process.argv[3]));
const expected = (Type, begin, count) => new Type(bytes.buffer.slice(begin, begin + count * Type.BYTES_PER_ELEMENT));
let wrong = 0;
let begin = 0;
for (const [name, words] of [["visibility", visibilityTexels(grid, visibility, atlas)], ["index", indexTexels(grid)]]) {
  const own = expected(Uint32Array, begin, words.length);
  const i = words.findIndex((word, j) => word !== own[j]);
  if (i >= 0) console.log(`${name} ${i}: ${words[i]}, not ${own[i]}`, ++wrong);
  begin += 4 * words.length;
}
const halves = expected(Uint16Array, begin, light.length);
const largest = halves.reduce((most, half) => Math.max(most, Math.abs(halfFloat(half))), 0);
halves.forEach((half, i) => {
  const off = Math.abs(halfFloat(light[i]) - halfFloat(half));
  if (!(off <= 2 ** -10 * Math.abs(halfFloat(half)) + 1e-6 * largest)) ++wrong;
});
console.log(`${wrong} of ${halves.length} differ`);
process.exitCode = wrong > 0 || begin + 2 * halves.length !== bytes.length ? 1 : 0;
