// Nodes of a glTF that draw instances of meshes with shared transfer (docs/format.md, PRTKIT_instances):
// three reads them as nodes without a mesh, and InstancedMesh draws them.

import { Matrix4, Quaternion, Vector3 } from "three";
import { FACTORS, LAMP_NUMBERS } from "./instanceModes.js";
import { checkInstanceNode, checkInstances, expect, INSTANCES, LARGEST_TRANSFER } from "./wholeExtension.js";

const GPU = "EXT_mesh_gpu_instancing";
/** Factors that transmit all light uniformly from above and below the horizon: 1 for an unoccluded instance; all others are 0. */
const EVEN = [3, 39];
const ROUNDING = 1e-5; // tolerance of an element, relative to the scale: matrices in files are floats

const holds = (value, what) => expect(value, what, INSTANCES);

/**
 * Removes meshes and instances of shared transfer from the nodes of `json`, a whole glTF, before three reads
 * it. Returns [{ node, mesh, first, box, attributes }]; `attributes`: the accessors of its instances, null if the node
 * is a single instance.
 */
export function takeInstancesAside(json) {
  const extension = json.extensions?.[INSTANCES];
  if (extension === undefined) return [];
  checkInstances(extension);
  const { nodes = [] } = json;
  holds(Array.isArray(nodes), "nodes is not a list");
  const shared = [];
  const sharedMeshes = new Set();
  for (const [node, drawing] of nodes.entries()) {
    const { mesh, skin, extensions } = drawing ?? {};
    const own = extensions?.[INSTANCES];
    if (own === undefined) continue;
    checkInstanceNode(own, node, extension.count, extension.boxes.length);
    holds(json.meshes?.[mesh], `node ${node} has no mesh`);
    holds(skin === undefined, `node ${node} has a skin`);
    shared.push({ node, mesh, first: own.first, box: own.box, attributes: extensions[GPU]?.attributes ?? null });
    sharedMeshes.add(mesh);
  }
  nodes.forEach((drawing, node) => {
    const isAlone = !sharedMeshes.has(drawing?.mesh) || drawing.extensions?.[INSTANCES] !== undefined;
    holds(isAlone, `node ${node} uses a mesh with shared transfer, but is not an instance`);
  });
  for (const { node } of shared) {
    delete nodes[node].mesh;
    delete nodes[node].extensions[GPU];
  }
  return shared;
}

/** Restores the original JSON. */
export function putInstancesBack({ nodes }, shared) {
  for (const { node, mesh, attributes } of shared) {
    nodes[node].mesh = mesh;
    if (attributes) nodes[node].extensions[GPU] = { attributes };
  }
}

/**
 * Returns the factors of all instances, [count][FACTORS]; `bytes`: their buffer view, which contains the
 * differences from an unoccluded instance.
 */
export function factorsOf({ count, factors: { scales } }, bytes) {
  holds(bytes.byteLength === FACTORS * count, `the factors do not have the size of ${count} instances`);
  const { buffer, byteOffset, byteLength } = bytes;
  const open = Float64Array.from(scales, (_, j) => Number(EVEN.includes(j)));
  const steps = new Int8Array(buffer, byteOffset, byteLength);
  const factors = new Float32Array(steps.length);
  for (let first = 0; first < factors.length; first += FACTORS)
    for (let j = 0; j < FACTORS; ++j) factors[first + j] = open[j] + scales[j] * steps[first + j];
  return factors;
}

/**
 * Returns the light of `lamps` lamps at all instances, [count][lamps][LAMP_NUMBERS]; `bytes`: its buffer view,
 * undefined without lamps.
 */
export function lampLightOf({ count, lamps: stored }, lamps, bytes) {
  holds((stored?.count ?? 0) === lamps, `the instances have the light of ${stored?.count ?? 0} lamps, the transfer has ${lamps}`);
  const light = new Float32Array(count * lamps * LAMP_NUMBERS);
  if (lamps === 0) return light;
  const size = 4 + LAMP_NUMBERS;
  holds(bytes.byteLength === count * lamps * size, `the light of lamps does not have the size of ${count} instances`);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  for (let n = 0; n < count * lamps; ++n) {
    const scale = view.getFloat32(n * size, true);
    holds(scale >= 0 && scale <= LARGEST_TRANSFER, "a scale of the light of lamps is invalid");
    for (let j = 0; j < LAMP_NUMBERS; ++j) light[n * LAMP_NUMBERS + j] = scale * view.getInt8(n * size + 4 + j);
  }
  return light;
}

/**
 * Returns the rotation of a matrix that rotates, moves and scales uniformly, [9] by columns; null for other
 * matrices.
 */
export function evenRotation({ elements: e }) {
  const axes = [0, 4, 8].map((at) => new Vector3(e[at], e[at + 1], e[at + 2]));
  const volume = axes[0].dot(axes[1].clone().cross(axes[2]));
  if (!(volume > 0 && volume < Infinity)) return null;
  const scale = Math.cbrt(volume);
  for (const axis of axes) axis.divideScalar(scale);
  const isSquare = axes.every((a, i) => axes.every((b, j) => Math.abs(a.dot(b) - Number(i === j)) < ROUNDING));
  return isSquare ? axes.flatMap((axis) => axis.toArray()) : null;
}

const SIZES = { TRANSLATION: 3, ROTATION: 4, SCALE: 3 };

/** Returns the matrices of the instances of a node, in its space, at most `most`; `parser`: of GLTFLoader. */
export async function matricesOf({ node, attributes }, parser, most) {
  if (attributes === null) return [new Matrix4()];
  const read = {};
  for (const [name, size] of Object.entries(SIZES)) {
    if (attributes[name] === undefined) continue;
    const claimed = parser.json.accessors?.[attributes[name]]?.count; // the data may be missing
    holds(claimed >= 1 && claimed <= most, `node ${node} has no instances, or more than there are factors`);
    try {
      read[name] = await parser.getDependency("accessor", attributes[name]);
    } catch (error) {
      throw new Error(`${INSTANCES}: accessor ${attributes[name]} cannot be read`, { cause: error });
    }
    holds(read[name]?.itemSize === size, `${name} of node ${node} is not a vector of ${size}`);
  }
  const counts = Object.values(read).map(({ count }) => count);
  holds(counts.length > 0 && counts.every((count) => count === counts[0]), `instance attributes of node ${node} are missing or have different lengths`);
  const [position, rotation, scale] = [new Vector3(), new Quaternion(), new Vector3(1, 1, 1)];
  return Array.from({ length: counts[0] }, (_, i) => {
    if (read.TRANSLATION) position.fromBufferAttribute(read.TRANSLATION, i);
    if (read.ROTATION) rotation.fromBufferAttribute(read.ROTATION, i).normalize();
    if (read.SCALE) scale.fromBufferAttribute(read.SCALE, i);
    return new Matrix4().compose(position, rotation, scale);
  });
}

/** Returns the animated nodes and their descendants. */
export function movingNodes({ animations = [], nodes = [] }) {
  const moving = new Set();
  const found = animations.flatMap((animation) => (animation?.channels ?? []).map((channel) => channel?.target?.node));
  while (found.length > 0) {
    const node = found.pop();
    if (moving.has(node) || !nodes[node]) continue;
    moving.add(node);
    for (const child of nodes[node].children ?? []) found.push(child);
  }
  return moving;
}
