// A small volume as `prt compress` writes it: two bricks of different levels, with synthetic transfer or with
// unoccluded probes; and its light, computed in plain JavaScript.
import { evaluateSh } from "../src/sphericalHarmonics.js";
import { Binary } from "./glb.js";
import { transferOf } from "./transferSets.js";
import { radianceOfWords } from "./wordRadiance.js";

export const PARTS = [
  { kind: "direct", channels: 1 },
  { kind: "indirect", channels: 3 },
  { kind: "lamp", channels: 3, name: "Lantern" },
];
const ORDER = 3;
const SIZE = 9 + 27 + 3;
const COMPONENTS = [3, 0, 5];
const WIDTHS = [[8, 5, 11], [], [16, 3, 9, 8, 7]];
const CLUSTER_BITS = 2;
const STRIDE = 2;
/** A coarse brick, and a fine one next to it; the box is larger than both. */
const BRICKS = [0, 0, 0, 1, 2, 0, 0, 0];
export const GRID = { origin: [-2, -0.5, -1.5], spacing: 0.25, size: [3, 2, 2] };
/** Two bricks of 125 probes each, of which 3 x 3 are one. */
export const PROBES = 250 - 9;

function random(seed) {
  let state = seed;
  return () => (state = (state * 1664525 + 1013904223) % 2 ** 32) / 2 ** 32;
}

/** Returns rows of an unoccluded probe: incident light equals the lighting. */
const openRow = (outputs) =>
  Array.from({ length: outputs }, (_, o) => Float32Array.from({ length: SIZE }, (__, i) => Number(i === o))).flatMap((row) => [...row]);

function rowsOf(outputs, open) {
  const next = random(11);
  const row = (isMean) => Array.from({ length: outputs * SIZE }, () => (open ? 0 : (isMean ? 0.3 : 0.2) * (next() - 0.4)));
  return COMPONENTS.flatMap((m) => [
    open ? openRow(outputs) : row(true),
    ...Array.from({ length: m }, () => row(false)),
  ]).flat();
}

function packedWidths() {
  const codes = WIDTHS.flat().map((width) => width - 1);
  return Uint8Array.from({ length: Math.ceil(codes.length / 2) }, (_, i) => codes[2 * i] | ((codes[2 * i + 1] ?? 0) << 4));
}

/** Returns words of probes, each in an existing cluster. */
function randomWords() {
  const next = random(5);
  for (let i = 0; i < 9; ++i) next();
  return Uint32Array.from({ length: STRIDE * PROBES }, (_, i) => {
    const word = Math.floor(next() * 2 ** 32) >>> 0;
    return i % STRIDE === 0 ? ((word & ~3) | ((i / STRIDE) % COMPONENTS.length)) >>> 0 : word;
  });
}

/** Returns visibility distances: full ones, some shorter ones, and some inside geometry. */
function visibilityOf(open) {
  const next = random(3);
  return Uint8Array.from({ length: 6 * PROBES }, (_, i) => {
    const visibility = 110 + Math.floor(145 * next());
    return open ? 255 : Math.floor(i / 6) % 17 === 3 ? 0 : Math.floor(i / 6) % 3 === 0 ? visibility : 255;
  });
}

/** Returns the set of probes, with its data in `binary`. */
export function volumeSet(binary, { incidentOrder = 3, open = false } = {}) {
  const outputs = incidentOrder ** 2;
  const view = (array) => ({ bufferView: binary.view(array) });
  return {
    receivers: "probes",
    coding: "clustered",
    order: ORDER,
    incidentOrder,
    terms: PARTS,
    ...GRID,
    bricks: view(Uint16Array.from(BRICKS)),
    visibility: view(visibilityOf(open)),
    components: COMPONENTS,
    bases: { ...view(Float32Array.from(rowsOf(outputs, open))), componentType: 5126 },
    packing: { clusterBits: CLUSTER_BITS, ...view(packedWidths()) },
    words: view(randomWords()),
  };
}

/** Returns a file that contains only a volume. */
export function volumeModel(options = {}, change = () => {}) {
  const binary = new Binary();
  const json = { scene: 0, scenes: [{ nodes: [] }], extensions: transferOf(volumeSet(binary, options)) };
  change(json, binary);
  return binary.file(json);
}

/** Returns the coefficients of incident light at a probe, [order²][3], under `columns` (lightColumns), from the words as
 * docs/format.md defines them, one output after the other. */
export function incidentAt({ clusters, words, stride }, probe, columns) {
  const own = [...words.subarray(stride * probe, stride * (probe + 1))];
  const { rowCount, outputs, rows } = clusters;
  const size = rows.length / (rowCount * outputs);
  return Array.from({ length: outputs }, (_, o) => {
    const outputRows = new Float32Array(rowCount * size);
    for (let r = 0; r < rowCount; ++r) outputRows.set(rows.subarray((r * outputs + o) * size, (r * outputs + o + 1) * size), r * size);
    return radianceOfWords({ ...clusters, rows: outputRows }, columns, own);
  });
}

const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

/** Returns the brick of `bricks` [n][4] that contains a position; -1 if there is none. */
function brickAt({ origin, spacing, size, bricks }, point) {
  const at = point.map((x, a) => clamp(Math.floor((x - origin[a]) / (4 * spacing)), 0, size[a] - 1));
  for (let b = 0; b < bricks.length / 4; ++b) {
    const width = 2 ** bricks[4 * b + 3];
    if (at.every((n, a) => n >= bricks[4 * b + a] && n < bricks[4 * b + a] + width)) return b;
  }
  return -1;
}

/** Returns [probe, weight] of the eight probes around a position, as defined in docs/format.md. */
export function weightsAt({ grid, visibility }, position, normal) {
  const { origin, spacing, size, bricks, ofBrick, corners, levels } = grid;
  const most = origin.map((x, a) => x + 4 * spacing * size[a]);
  const inside = position.map((x, a) => clamp(x, origin[a], most[a]));
  let b = Math.max(0, brickAt(grid, inside));
  const biased = inside.map((x, a) => clamp(x + 0.25 * spacing * 2 ** bricks[4 * b + 3] * normal[a], origin[a], most[a]));
  const there = brickAt(grid, biased);
  if (there >= 0) b = there;
  const cell = spacing * 2 ** bricks[4 * b + 3];
  const at = biased.map((x, a) => clamp((x - origin[a] - 4 * spacing * bricks[4 * b + a]) / cell, 0, 4));
  const low = at.map((x) => Math.min(Math.floor(x), 3));
  const found = Array.from({ length: 8 }, (_, i) => {
    const step = [i & 1, (i >> 1) & 1, i >> 2];
    const corner = low.map((x, a) => x + step[a]);
    const probe = ofBrick[125 * b + (corner[2] * 5 + corner[1]) * 5 + corner[0]];
    const trilinear = step.reduce((product, s, a) => product * (s ? at[a] - low[a] : 1 - at[a] + low[a]), 1);
    const passed = biased.reduce((largest, x, a) => {
      const from = x - (origin[a] + spacing * corners[3 * probe + a]);
      const distance = visibility[6 * probe + 2 * a + (from > 0 ? 1 : 0)];
      return Math.max(largest, Math.abs(from) / Math.max(4 * spacing * 2 ** levels[probe] * (distance / 255) ** 2, 1e-18));
    }, 0);
    const t = clamp((passed - 0.8) / 0.23, 0, 1);
    return [probe, trilinear * Math.max(1 - t * t * (3 - 2 * t), 1e-4 / clamp(passed, 1, 16) ** 8)];
  });
  const sum = found.reduce((total, [, weight]) => total + weight, 0);
  return found.map(([probe, weight]) => [probe, weight / sum]);
}

/** Returns the coefficients of incident light at a position. */
export function incidentAround(volume, position, normal, columns) {
  const light = Array.from({ length: volume.clusters.outputs }, () => [0, 0, 0]);
  for (const [probe, weight] of weightsAt(volume, position, normal))
    incidentAt(volume, probe, columns).forEach((value, o) => value.forEach((x, c) => (light[o][c] += weight * x)));
  return light;
}

const COSINE = [1, 2 / 3, 1 / 4, 0];

/** Returns radiance in a direction with factors `bands[l]` per band l; by default irradiance over pi. */
export function sumOf(light, direction, bands = COSINE) {
  const basis = evaluateSh(Math.sqrt(light.length), ...direction);
  return [0, 1, 2].map((c) =>
    Math.max(0, light.reduce((sum, value, i) => sum + bands[Math.floor(Math.sqrt(i + 0.5))] * basis[i] * value[c], 0)),
  );
}
