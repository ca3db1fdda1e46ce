// Transforms the attributes of a mesh, as loaded by GLTFLoader, to the space of the bake, which predictors
// use: the world of the file, independent of later transforms of the model.

import { BufferAttribute, Matrix3, Matrix4, Vector3 } from "three";
import { expect, LARGEST_WEIGHT } from "./wholeExtension.js";

/**
 * Returns the cofactors of a matrix, which rotate normals, scaled to a safe range of floats; also works without an
 * inverse.
 */
export function normalMatrix(matrix) {
  const [x, y, z] = [0, 1, 2].map((column) => new Vector3().setFromMatrixColumn(matrix, column));
  const side = matrix.determinant() < 0 ? -1 : 1;
  const cofactors = [y.clone().cross(z), z.clone().cross(x), x.clone().cross(y)].flatMap((v) => v.toArray());
  const largest = Math.max(...cofactors.map(Math.abs));
  return new Matrix3().fromArray(cofactors.map((value) => (largest > 0 ? (side * value) / largest : 0)));
}

/** Returns the matrix of vertex `v` of a skinned mesh in the current pose of its bones. */
function skinMatrix({ geometry, skeleton }, v) {
  const { skinIndex, skinWeight } = geometry.attributes;
  const sum = new Matrix4().multiplyScalar(0);
  const bone = new Matrix4();
  for (let i = 0; i < 4; ++i) {
    const weight = skinWeight.getComponent(v, i);
    if (weight === 0) continue;
    const joint = skinIndex.getComponent(v, i);
    bone.multiplyMatrices(skeleton.bones[joint].matrixWorld, skeleton.boneInverses[joint]);
    bone.elements.forEach((value, e) => (sum.elements[e] += weight * value));
  }
  return sum;
}

/** Returns a vector of an attribute with its morph targets added. */
function morphed({ geometry, morphTargetInfluences }, name, v) {
  const vector = new Vector3();
  if (!geometry.hasAttribute(name)) return vector;
  vector.fromBufferAttribute(geometry.getAttribute(name), v);
  (geometry.morphAttributes[name] ?? []).forEach((deltas, t) => {
    const influence = morphTargetInfluences?.[t] ?? 0;
    if (influence !== 0) vector.addScaledVector(new Vector3().fromBufferAttribute(deltas, v), influence);
  });
  return vector;
}

/** Returns the sums of the triangles' normals at each vertex, for vertices without normals. */
function normalsOfTriangles({ index }, points) {
  const sums = points.map(() => new Vector3());
  const corner = (i) => (index ? index.getX(i) : i);
  const count = index ? index.count : points.length;
  for (let t = 0; t + 2 < count; t += 3) {
    const [a, b, c] = [corner(t), corner(t + 1), corner(t + 2)];
    const normal = points[b].clone().sub(points[a]).cross(points[c].clone().sub(points[a]));
    for (const v of [a, b, c]) sums[v].add(normal);
  }
  return sums;
}

/** True if floats can represent the square of a vector, also after a transform. */
const isOfUsualLength = (vector) => vector.lengthSq() > 1e-12 && vector.lengthSq() < 1e12;

/** True if the shader cannot normalise the normals of some vertices. */
function lacksNormals({ attributes: { normal, position } }) {
  if (normal?.count !== position.count) return true;
  const vector = new Vector3();
  for (let v = 0; v < normal.count; ++v) if (!isOfUsualLength(vector.fromBufferAttribute(normal, v))) return true;
  return false;
}

/** Returns the vector with length 1, or zero if it cannot be normalised. */
function unitOrZero(vector) {
  const length = vector.length();
  return length > 0 && length < Infinity ? vector.divideScalar(length) : vector.set(0, 0, 0);
}

/**
 * Returns positions relative to `origin` and normals of all vertices as attributes, for meshes that no single
 * matrix transforms.
 */
function bakedAttributes(mesh, world, origin) {
  const { geometry } = mesh;
  const vertices = Array.from({ length: geometry.getAttribute("position").count }, (_, v) => v);
  const matrices = vertices.map((v) => (mesh.isSkinnedMesh ? skinMatrix(mesh, v) : world));
  const points = vertices.map((v) => morphed(mesh, "position", v).applyMatrix4(matrices[v]).sub(origin));
  const normals = vertices.map((v) => unitOrZero(morphed(mesh, "normal", v).applyMatrix3(normalMatrix(matrices[v]))));
  if (normals.some((normal) => normal.lengthSq() === 0)) {
    // A mirroring node reverses the winding of triangles.
    const side = !mesh.isSkinnedMesh && world.determinant() < 0 ? -1 : 1;
    const sums = normalsOfTriangles(geometry, points);
    normals.forEach((normal, v) => normal.lengthSq() === 0 && unitOrZero(normal.copy(sums[v]).multiplyScalar(side)));
  }
  const attribute = (vectors) => new BufferAttribute(Float32Array.from(vectors.flatMap((vector) => vector.toArray())), 3);
  geometry.setAttribute("prt_baked_position", attribute(points));
  geometry.setAttribute("prt_baked_normal", attribute(normals));
}

/**
 * Throws if a position is farther from the origin of its predictor than the predictor's `scale` allows, or
 * NaN.
 */
function checkPositions(mesh, toBake, { scale }) {
  const { prt_baked_position: baked, position } = mesh.geometry.attributes;
  const [points, matrix] = baked ? [baked, new Matrix4()] : [position, toBake];
  const point = new Vector3();
  for (let v = 0; v < points.count; ++v) {
    const scaled = point.fromBufferAttribute(points, v).applyMatrix4(matrix).toArray().map((x, i) => Math.abs(x * scale[i]));
    expect(scaled.every((x) => x <= LARGEST_WEIGHT), `vertex ${v} is farther from the origin of a predictor than its scale allows`);
  }
}

/** True if floats would lose digits of positions: the matrix moves the mesh by far more than its size. */
function isFar({ geometry }, toBake) {
  if (!geometry.boundingBox) geometry.computeBoundingBox();
  const size = geometry.boundingBox.clone().applyMatrix4(toBake).getSize(new Vector3()).length();
  return new Vector3().setFromMatrixPosition(toBake).length() > 100 * size;
}

/**
 * Returns the shader inputs of `mesh` for `predictors`: { defines, uniforms }. The world matrices of its scene
 * must be those of the file. Skinned and morphed meshes, meshes without normals and small ones far from their
 * origin get separate attributes, in the pose of the file. `world`: transform from the mesh to the space of
 * the bake.
 */
export function bakedFrame(mesh, predictors, world = mesh.matrixWorld) {
  if (predictors.length === 0) return { defines: {}, uniforms: {} };
  const hasNormals = predictors[0].kind === "normal";
  const position = predictors.find(({ kind }) => kind === "position");
  const origin = new Vector3(...(position?.origin ?? [0, 0, 0]));
  const defines = {};
  if (hasNormals) defines.PRT_PREDICTOR_NORMAL = 1;
  // The matrix or the attribute already subtracts the origin, in double precision.
  if (position) Object.assign(defines, { PRT_PREDICTOR_POSITION: 1, PRT_PREDICTOR_ORIGIN: "vec3(0.0)" });
  const toBake = new Matrix4().makeTranslation(origin.clone().negate()).multiply(world);
  const moves = mesh.isSkinnedMesh || mesh.morphTargetInfluences?.some((influence) => influence !== 0);
  if (moves || (hasNormals && lacksNormals(mesh.geometry)) || (position && isFar(mesh, toBake))) {
    bakedAttributes(mesh, world, origin);
    defines.PRT_BAKED_ATTRIBUTES = 1;
  }
  if (position || defines.PRT_BAKED_ATTRIBUTES) checkPositions(mesh, toBake, position ?? { scale: [1, 1, 1] });
  return {
    defines,
    uniforms: { prtToBake: { value: toBake }, prtNormalToBake: { value: normalMatrix(world) } },
  };
}
