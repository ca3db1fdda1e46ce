// What objects that move take from the light of baked surfaces near them: PRTKIT_occlusion_volume, of `prt ao --volume`.

import { ByteType, Data3DTexture, LinearFilter, Matrix3, RGBAFormat, Vector3, Vector4 } from "three";
import { checkOccluder, expect, OCCLUDERS } from "./wholeExtension.js";

const SIDE = 8;
const BYTES = 4 * SIDE ** 3;
/** Of shared_layout.h. */
export const MOST_OCCLUDERS = 32;

/** The parts of a file that take light: [{ object, low, high, reach, texels }]. */
export async function occludersOf({ json, associations }, gltf, viewsOf) {
  const { nodes: all = [] } = json;
  expect(Array.isArray(all), "nodes are no list", OCCLUDERS);
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
  expect(found.length <= MOST_OCCLUDERS, `there are ${found.length} parts, more than ${MOST_OCCLUDERS}`, OCCLUDERS);
  return found;
}

/** Whether an object is to be seen, as far as it and what it is in say. */
function isShown(object) {
  for (let at = object; at; at = at.parent) if (!at.visible) return false;
  return true;
}

/** Where a part stands, as five rows of the shader: prt::placed. Returns the middle of what it reaches. */
function place({ object, low, high, reach }, slot, rows) {
  const linear = new Matrix3().setFromMatrix4(object.matrixWorld);
  const scale = Math.cbrt(Math.abs(linear.determinant()));
  const centre = new Vector3(...low.map((value, axis) => 0.5 * (value + high[axis]))).applyMatrix4(object.matrixWorld);
  const inverse = linear.invert().multiplyScalar(scale).elements; // zero where there is none
  for (let axis = 0; axis < 3; ++axis) {
    const row = new Vector3(inverse[axis], inverse[3 + axis], inverse[6 + axis]);
    rows[axis].set(row.x, row.y, row.z, -row.dot(centre));
  }
  rows[3].set(...low.map((value, axis) => 0.5 * scale * (high[axis] - value)), scale * reach);
  rows[4].set(slot, 0, 0, 0);
  return centre;
}

/** Of one file, `gltf.userData.prtkitOccluders`: given to `setOccluders` of what they pass. */
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
    this.reach = new Vector4(); // a sphere, out of which none takes any
  }

  /** Takes the parts where they are now; those that are not shown take nothing. */
  update() {
    this.count = 0;
    const centres = this.parts.flatMap((part, slot) => (isShown(part.object) ? [place(part, slot, this.rows.slice(5 * this.count++))] : []));
    const middle = centres.reduce((sum, centre) => sum.addScaledVector(centre, 1 / centres.length), new Vector3());
    const reach = centres.reduce((most, centre, i) => Math.max(most, middle.distanceTo(centre) + this.rows[5 * i + 3].w), 0);
    this.reach.set(...middle, reach);
  }

  dispose() {
    this.texture.dispose();
  }
}
