// Rotations of a scene and a model, as matrices by columns, [9], the format of ShLight.rotated.

import { Euler, Matrix4, REVISION, Vector3 } from "three";

const upperLeft = ({ elements: e }) => [e[0], e[1], e[2], e[4], e[5], e[6], e[8], e[9], e[10]];
const transposed = (m) => [m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]];

/** Returns the product a b of two matrices. */
function product(a, b) {
  return Array.from({ length: 9 }, (_, i) => {
    const [column, row] = [Math.floor(i / 3), i % 3];
    return a[row] * b[3 * column] + a[3 + row] * b[3 * column + 1] + a[6 + row] * b[3 * column + 2];
  });
}

/**
 * Returns three's rotation of an equirectangular environment by `euler`: light of direction d in the image
 * comes from this matrix times d.
 */
export function environmentRotation(euler, revision = Number.parseInt(REVISION)) {
  if (revision >= 184) return upperLeft(new Matrix4().makeRotationFromEuler(euler));
  // Earlier releases look up directions rotated by the negative angles in the same order.
  const lookup = new Euler(-euler.x, -euler.y, -euler.z, euler.order);
  return transposed(upperLeft(new Matrix4().makeRotationFromEuler(lookup)));
}

/** Returns the rotation of an object in the world, without its position and scale; mirrored if the object is. */
function worldRotation({ matrixWorld }) {
  const axes = [0, 1, 2].map((column) => new Vector3().setFromMatrixColumn(matrixWorld, column).normalize());
  axes[1].addScaledVector(axes[0], -axes[1].dot(axes[0])).normalize();
  axes[2].addScaledVector(axes[0], -axes[2].dot(axes[0])).addScaledVector(axes[1], -axes[2].dot(axes[1])).normalize();
  return axes.flatMap((axis) => axis.toArray());
}

/**
 * Returns rotation and strength of the environment of `scene`, or those of the background without an
 * environment.
 */
export function shownBy(scene) {
  return scene.environment
    ? { euler: scene.environmentRotation, strength: scene.environmentIntensity }
    : { euler: scene.backgroundRotation, strength: scene.backgroundIntensity };
}

/** Returns the rotation from world directions to those of `root`, the model as baked. */
export const rotationIntoModel = (root) => transposed(worldRotation(root));

/**
 * Returns the rotation from the directions of the image to those of `root`, the model as baked, which may be
 * rotated since.
 */
export function rotationForModel(scene, root) {
  return product(rotationIntoModel(root), environmentRotation(shownBy(scene).euler));
}

/** Returns the vector `v` [3] rotated by a matrix. */
export function rotatedBy(m, [x, y, z]) {
  return [m[0] * x + m[3] * y + m[6] * z, m[1] * x + m[4] * y + m[7] * z, m[2] * x + m[5] * y + m[8] * z];
}
