// Occlusion of baked surfaces by moving objects near them: PRTKIT_occlusion_volume, from `prt ao --occluders`.

import { ByteType, Data3DTexture, LinearFilter, Matrix3, RGBAFormat, Vector3, Vector4 } from "three";
import { checkOccluder, expect, OCCLUDERS } from "./wholeExtension.js";

const SIDE = 8;
const BYTES = 4 * SIDE ** 3;
/** Equal to the value in shared_layout.h. */
export const MOST_OCCLUDERS = 32;

/** Returns the occluders of a file: [{ object, low, high, reach, texels }]. */
export async function occludersOf({ json, associations }, gltf, viewsOf) {
  const { nodes: all = [] } = json;
  expect(Array.isArray(all), "nodes is not a list", OCCLUDERS);
  const nodes = all.map((node) => node?.extensions?.[OCCLUDERS]);
  if (nodes.every((extension) => extension === undefined)) return [];
  expect(gltf.scene, "the file has no scene", OCCLUDERS);
  const objects = new Map();
  gltf.scene.traverse((object) => {
    const { nodes: node } = associations.get(object) ?? {};
    if (node !== undefined && !objects.has(node)) objects.set(node, object);
  });
  const found = [];
  for (const [node, extension] of nodes.entries()) {
    if (extension === undefined) continue;
    checkOccluder(extension);
    const { min, max, reach, texels: { bufferView } } = extension;
    const texels = (await viewsOf([bufferView])).get(bufferView);
    expect(texels.byteLength === BYTES, `node ${node} has ${texels.byteLength} bytes of texels, not ${BYTES}`, OCCLUDERS);
    if (objects.has(node)) found.push({ object: objects.get(node), low: min, high: max, reach, texels });
  }
  expect(found.length <= MOST_OCCLUDERS, `there are ${found.length} occluders; at most ${MOST_OCCLUDERS} are supported`, OCCLUDERS);
  return found;
}

/** True if an object and all its ancestors are visible. */
function isShown(object) {
  for (let at = object; at; at = at.parent) if (!at.visible) return false;
  return true;
}

/** Writes the transform of an occluder as five rows of the shader: prt::placed. Returns the center of its reach. */
function updateRows({ object, low, high, reach }, slot, rows) {
  const linear = new Matrix3().setFromMatrix4(object.matrixWorld);
  const scale = Math.cbrt(Math.abs(linear.determinant()));
  const centre = new Vector3(...low.map((value, axis) => 0.5 * (value + high[axis]))).applyMatrix4(object.matrixWorld);
  const inverse = linear.invert().multiplyScalar(scale).elements; // zero if there is no inverse
  for (let axis = 0; axis < 3; ++axis) {
    const row = new Vector3(inverse[axis], inverse[3 + axis], inverse[6 + axis]);
    rows[axis].set(row.x, row.y, row.z, -row.dot(centre));
  }
  rows[3].set(...low.map((value, axis) => 0.5 * scale * (high[axis] - value)), scale * reach);
  rows[4].set(slot, 0, 0, 0);
  return centre;
}

/** Occluders of one file, `gltf.userData.prtkitOccluders`: pass it to `setOccluders` of the surfaces. */
export class PrtkitOccluders {
  constructor(parts) {
    this.parts = parts;
    const texels = new Int8Array(BYTES * parts.length);
    parts.forEach((part, i) => texels.set(part.texels, BYTES * i));
    this.texture = new Data3DTexture(texels, SIDE, SIDE, SIDE * parts.length);
    Object.assign(this.texture, { format: RGBAFormat, type: ByteType, internalFormat: "RGBA8_SNORM", needsUpdate: true });
    this.texture.minFilter = this.texture.magFilter = LinearFilter;
    this.rows = Array.from({ length: 5 * MOST_OCCLUDERS }, () => new Vector4());
    this.count = 0;
    this.reach = new Vector4(); // a sphere that contains all reaches
  }

  /** Updates the positions of the occluders; invisible ones do not occlude. */
  update() {
    this.count = 0;
    const centres = this.parts.flatMap((part, slot) => (isShown(part.object) ? [updateRows(part, slot, this.rows.slice(5 * this.count++))] : []));
    const middle = centres.reduce((sum, centre) => sum.addScaledVector(centre, 1 / centres.length), new Vector3());
    const reach = centres.reduce((most, centre, i) => Math.max(most, middle.distanceTo(centre) + this.rows[5 * i + 3].w), 0);
    this.reach.set(...middle, reach);
  }

  dispose() {
    this.texture.dispose();
  }
}
