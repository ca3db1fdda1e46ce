// Which way a scene and a model are turned, as rotation matrices by columns, [9]: what ShLight.rotated takes.

import { Euler, Matrix4, REVISION, Vector3 } from "three";

const upperLeft = ({ elements: e }) => [e[0], e[1], e[2], e[4], e[5], e[6], e[8], e[9], e[10]];
const transposed = (m) => [m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]];

/** The product a b of two matrices. */
function product(a, b) {
  return Array.from({ length: 9 }, (_, i) => {
    const [column, row] = [Math.floor(i / 3), i % 3];
    return a[row] * b[3 * column] + a[3 + row] * b[3 * column + 1] + a[6 + row] * b[3 * column + 2];
  });
}

/** How three turns an equirectangular environment by `euler`: light of direction d in the image comes from this times d. */
export function environmentTurn(euler, revision = Number.parseInt(REVISION)) {
  if (revision >= 184) return upperLeft(new Matrix4().makeRotationFromEuler(euler));
  // Earlier releases look up directions turned by the negative angles in the same order.
  const lookup = new Euler(-euler.x, -euler.y, -euler.z, euler.order);
  return transposed(upperLeft(new Matrix4().makeRotationFromEuler(lookup)));
}

/** The turn of an object in the world, without its place and its scale; mirrored where the object is. */
function worldTurn({ matrixWorld }) {
  const axes = [0, 1, 2].map((column) => new Vector3().setFromMatrixColumn(matrixWorld, column).normalize());
  axes[1].addScaledVector(axes[0], -axes[1].dot(axes[0])).normalize();
  axes[2].addScaledVector(axes[0], -axes[2].dot(axes[0])).addScaledVector(axes[1], -axes[2].dot(axes[1])).normalize();
  return axes.flatMap((axis) => axis.toArray());
}

/** What `scene` shows its environment by: its own turn and strength, or, where it has none, those of the background. */
export function shownBy(scene) {
  return scene.environment
    ? { euler: scene.environmentRotation, strength: scene.environmentIntensity }
    : { euler: scene.backgroundRotation, strength: scene.backgroundIntensity };
}

/** From the directions of the world to those of `root`, the model as it was baked, where it may be turned since. */
export const turnIntoModel = (root) => transposed(worldTurn(root));

/** The same from the directions of the image. */
export function turnForModel(scene, root) {
  return product(turnIntoModel(root), environmentTurn(shownBy(scene).euler));
}

/** The vector `v` [3] turned by a matrix. */
export function turnedBy(m, [x, y, z]) {
  return [m[0] * x + m[3] * y + m[6] * z, m[1] * x + m[4] * y + m[7] * z, m[2] * x + m[5] * y + m[8] * z];
}
