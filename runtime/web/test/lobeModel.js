// A small figure as `prt lobes` writes it, with synthetic lobes: squares in a plane, moved by two bones; and
// their radiance, computed in plain JavaScript.
import { Euler, Matrix3, Matrix4, Vector3 } from "three";
import { evaluateSh } from "../src/sphericalHarmonics.js";
import { Binary } from "./glb.js";

export const [ACROSS, DOWN, LOBES, PROFILES] = [6, 5, 2, 7];
const SIZE = 0.11; // half the side of a square

function random(seed) {
  let state = seed;
  const next = () => (state = (state * 1664525 + 1013904223) % 2 ** 32) / 2 ** 32;
  for (let skipped = 0; skipped < 9; ++skipped) next();
  return next;
}

/** Returns the gains of each profile: those of an unoccluded vertex, varied. */
export function profiles(order) {
  const next = random(3);
  return Array.from({ length: PROFILES }, () => [1, 2 / 3, 1 / 4, 0.1].slice(0, order).map((gain) => gain * (0.4 + next())));
}

/** Returns for each square its middle, its normal, the weight of the first bone, and the bytes of its lobes. */
export function squares() {
  const next = random(5);
  return Array.from({ length: ACROSS * DOWN }, (_, i) => ({
    point: [(((i % ACROSS) + 0.5) / ACROSS - 0.5) * 1.8, ((Math.floor(i / ACROSS) + 0.5) / DOWN - 0.5) * 1.6, 0],
    normal: new Vector3(next() - 0.5, next() - 0.5, 1).normalize().toArray(),
    share: Math.round(4 * next()) / 4,
    lobes: Array.from({ length: LOBES }, () => [255 * next(), 255 * next(), PROFILES * next(), 120 + 135 * next()].map(Math.floor)),
  }));
}

export function lobeModel(order = 4, change = () => {}) {
  const binary = new Binary();
  const all = squares();
  const four = (of) => all.flatMap((square) => [0, 1, 2, 3].flatMap((corner) => of(square, corner)));
  const position = ({ point: [x, y, z] }, corner) => [x + (corner & 1 ? SIZE : -SIZE), y + (corner & 2 ? SIZE : -SIZE), z];
  const attributes = {
    POSITION: binary.accessor(new Float32Array(four(position)), "VEC3", { min: [-1, -1, 0], max: [1, 1, 0] }),
    NORMAL: binary.accessor(new Float32Array(four(({ normal }) => normal)), "VEC3"),
    JOINTS_0: binary.accessor(new Uint8Array(four(() => [0, 1, 0, 0])), "VEC4"),
    WEIGHTS_0: binary.accessor(new Float32Array(four(({ share }) => [share, 1 - share, 0, 0])), "VEC4"),
  };
  for (let k = 0; k < LOBES; ++k) attributes[`_PRT_LOBE_${k}`] = binary.accessor(new Uint8Array(four(({ lobes }) => lobes[k])), "VEC4");
  const indices = binary.accessor(new Uint32Array(all.flatMap((_, i) => [0, 1, 2, 2, 1, 3].map((corner) => 4 * i + corner))), "SCALAR");
  const json = {
    extensionsUsed: ["PRTKIT_lobes"],
    scene: 0,
    scenes: [{ nodes: [0, 1] }],
    nodes: [{ mesh: 0, skin: 0 }, { name: "one", children: [2] }, { name: "other" }],
    skins: [{ joints: [1, 2] }],
    materials: [{ doubleSided: true, pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 1 } }],
    meshes: [{ primitives: [{ attributes, indices, material: 0 }] }],
    extensions: {
      PRTKIT_lobes: {
        version: 1,
        order,
        lobes: LOBES,
        profiles: { bufferView: binary.view(new Float32Array(profiles(order).flat())), componentType: 5126, count: PROFILES },
      },
    },
  };
  change(json, binary);
  return binary.file(json);
}

/** Returns the matrices of the two bones, rotated by Euler angles; the second is a child of the first. */
export function boneMatrices([first, second]) {
  const [one, other] = [first, second].map((angles) => new Matrix4().makeRotationFromEuler(new Euler(...angles)));
  return [one, one.clone().multiply(other)];
}

/** Returns the unit axis encoded by two bytes. */
function axisOf([a, b]) {
  let [x, y] = [a, b].map((byte) => Math.min((byte - 127) / 127, 1));
  const z = 1 - Math.abs(x) - Math.abs(y);
  if (z < 0) [x, y] = [(1 - Math.abs(y)) * (x < 0 ? -1 : 1), (1 - Math.abs(x)) * (y < 0 ? -1 : 1)];
  return new Vector3(x, y, z).normalize();
}

const skinOf = (share, bones) => {
  const skin = new Matrix4();
  skin.elements.forEach((_, i) => (skin.elements[i] = share * bones[0].elements[i] + (1 - share) * bones[1].elements[i]));
  return skin;
};
const rotationOf = (skin) => new Matrix3().setFromMatrix4(skin).invert().transpose();

/** Returns the positions of the ends of a square's diagonal, and its normal there. */
export function cornersOf({ point: [x, y, z], normal, share }, bones) {
  const skin = skinOf(share, bones);
  const rotated = new Vector3(...normal).applyMatrix3(rotationOf(skin)).normalize().toArray();
  return [1, -1].map((side) => ({ point: new Vector3(x + side * SIZE, y - side * SIZE, z).applyMatrix4(skin).toArray(), normal: rotated }));
}

/** Returns the position of a square, and its radiance for albedo 1 under coefficients [order²][3]. */
export function radianceOf({ point, share, lobes }, bones, order, light) {
  const skin = skinOf(share, bones);
  const rotation = rotationOf(skin);
  const gains = profiles(order);
  const sum = [0, 0, 0];
  for (const [a, b, profile, scale] of lobes) {
    const axis = axisOf([a, b]).applyMatrix3(rotation).normalize();
    evaluateSh(order, axis.x, axis.y, axis.z).forEach((value, i) => {
      const gain = (scale / 255) * gains[profile][Math.floor(Math.sqrt(i + 0.5))];
      sum.forEach((_, c) => (sum[c] += gain * value * light[3 * i + c]));
    });
  }
  return { point: new Vector3(...point).applyMatrix4(skin), radiance: sum.map((value) => Math.max(value, 0)) };
}
