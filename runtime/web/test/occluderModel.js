// A file with occluders and synthetic texels; and their occlusion, computed in plain JavaScript.
import { Matrix4, Vector3 } from "three";
import { Binary } from "./glb.js";

const SIDE = 8;
export const BOXES = [
  { min: [-0.3, -0.2, -0.4], max: [0.5, 0.6, 0.3], reach: 2.5 },
  { min: [-0.1, -0.1, -0.1], max: [0.2, 0.3, 0.1], reach: 0.9 },
];

/**
 * Returns the mean blocked direction and the square root of the blocked fraction, -1..1 in 127ths, smooth
 * over the box.
 */
function texelsOf(box) {
  const texels = new Int8Array(4 * SIDE ** 3);
  for (let i = 0; i < SIDE ** 3; ++i) {
    const [x, y, z] = [i % SIDE, Math.floor(i / SIDE) % SIDE, Math.floor(i / SIDE ** 2)].map((n) => n / (SIDE - 1) - 0.5);
    const lean = [-x, -y, -z].map((value) => value / Math.max(Math.hypot(x, y, z), 0.3));
    texels.set([...lean.map((value) => Math.round(110 * value)), Math.round(60 - 90 * Math.hypot(x, y, z) + 20 * box)], 4 * i);
  }
  return texels;
}

export function occluderModel(change = () => {}) {
  const binary = new Binary();
  const nodes = BOXES.map((box, i) => ({
    extensions: { PRTKIT_occlusion_volume: { version: 1, ...box, texels: { bufferView: binary.view(texelsOf(i)) } } },
  }));
  const json = { scene: 0, scenes: [{ nodes: [0, 1] }], nodes };
  change(json, binary);
  return binary.file(json);
}

const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

/** The four numbers between texels, [-1, 1] along each axis. */
function filtered(texels, at) {
  const point = at.map((x) => clamp(((x + 1) / 2) * (SIDE - 1), 0, SIDE - 1));
  const low = point.map((x) => Math.min(Math.floor(x), SIDE - 2));
  const sum = [0, 0, 0, 0];
  for (let i = 0; i < 8; ++i) {
    const step = [i & 1, (i >> 1) & 1, i >> 2];
    const weight = step.reduce((product, s, a) => product * (s ? point[a] - low[a] : 1 - point[a] + low[a]), 1);
    const [x, y, z] = step.map((s, a) => low[a] + s);
    for (let c = 0; c < 4; ++c) sum[c] += (weight * Math.max(texels[4 * ((z * SIDE + y) * SIDE + x) + c], -127)) / 127;
  }
  return sum;
}

/**
 * Returns the fraction of the cosine-weighted hemisphere about `normal` that an evenly blocked cap covers, by a
 * grid of directions.
 */
function capCosine(towards, share, normal) {
  const least = 1 - 2 * share; // cosine of its border
  const axis = new Vector3(...towards);
  const side = new Vector3(Math.abs(axis.x) < 0.9 ? 1 : 0, Math.abs(axis.x) < 0.9 ? 0 : 1, 0).cross(axis).normalize();
  const third = axis.clone().cross(side);
  const n = new Vector3(...normal);
  const [rings, steps] = [160, 160];
  let sum = 0;
  for (let r = 0; r < rings; ++r) {
    const cosine = 1 - ((r + 0.5) / rings) * (1 - least);
    const sine = Math.sqrt(1 - cosine * cosine);
    for (let s = 0; s < steps; ++s) {
      const angle = (2 * Math.PI * (s + 0.5)) / steps;
      const along = cosine * n.dot(axis) + sine * (Math.cos(angle) * n.dot(side) + Math.sin(angle) * n.dot(third));
      sum += Math.max(along, 0);
    }
  }
  return (sum / (rings * steps)) * 4 * share; // over pi, of 4 pi share
}

/**
 * Returns the fraction of uniform light that remains at a receiver with one occluder at `matrix`, as defined in
 * docs/format.md.
 */
function leftBy({ min, max, reach }, texels, matrix, position, normal) {
  const scale = Math.cbrt(matrix.determinant());
  const middle = min.map((value, a) => (value + max[a]) / 2);
  const local = new Vector3(...position).applyMatrix4(matrix.clone().invert()).toArray().map((x, a) => x - middle[a]);
  const half = min.map((value, a) => (max[a] - value) / 2);
  const far = Math.hypot(...local);
  if (far >= reach) return 1;
  const inside = local.map((x, a) => clamp(x, -half[a], half[a]));
  const stored = filtered(texels, inside.map((x, a) => x / half[a]));
  let root = (stored[3] + 1) / 2;
  let lean = stored.slice(0, 3);
  if (inside.some((x, a) => x !== local[a])) {
    const border = Math.hypot(...inside);
    root *= border / far;
    const size = Math.hypot(...lean);
    lean = lean.map((x, a) => x + size * (inside[a] / border - local[a] / far));
  }
  const t = clamp((far / reach - 0.6) / 0.4, 0, 1);
  const blocked = root * root * (1 - t * t * (3 - 2 * t));
  if (blocked <= 0) return 1;
  const rotated = new Vector3(...lean).applyMatrix4(matrix.clone().setPosition(0, 0, 0)).divideScalar(scale);
  const share = Math.max(1 - (1 - blocked) * Math.min(rotated.length(), 1), blocked);
  return 1 - (blocked / share) * capCosine(rotated.normalize().toArray(), share, normal);
}

/** Returns the fraction that remains with all occluders, at the matrices `moved`. */
export function leftAt(moved, position, normal) {
  return BOXES.reduce((left, box, i) => left * leftBy(box, texelsOf(i), new Matrix4().fromArray(moved[i]), position, normal), 1);
}
