// Compares positions and normals of predictors with those in the world space of the file.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Bone, BufferAttribute, BufferGeometry, Group, Matrix4, Mesh, Quaternion, Skeleton, SkinnedMesh, Vector3 } from "three";
import { bakedFrame } from "../src/bakedFrame.js";

const ORIGIN = [1, -2, 3];
const PREDICTORS = [{ kind: "normal", scale: [1, 1, 1] }, { kind: "position", origin: ORIGIN, scale: [1, 1, 1] }];

const POSITIONS = [[0, 0, 0], [1, 0, 0], [0, 1, 0.5]];
const NORMALS = [[0, 0, 1], [0.6, 0, 0.8], [0, 0.8, -0.6]];

function geometryOf(positions = POSITIONS, normals = NORMALS) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions.flat()), 3));
  if (normals) geometry.setAttribute("normal", new BufferAttribute(new Float32Array(normals.flat()), 3));
  return geometry;
}

/** Returns the values that the shader computes for vertex `v`. */
function inShader(mesh, { defines, uniforms }, v) {
  const { attributes } = mesh.geometry;
  if (defines.PRT_BAKED_ATTRIBUTES)
    return [attributes.prt_baked_position, attributes.prt_baked_normal].map((a) => new Vector3().fromBufferAttribute(a, v));
  const point = new Vector3().fromBufferAttribute(attributes.position, v).applyMatrix4(uniforms.prtToBake.value);
  const normal = new Vector3().fromBufferAttribute(attributes.normal, v).applyMatrix3(uniforms.prtNormalToBake.value);
  return [point, normal.normalize()];
}

const near = (vector, expected, most = 1e-6) =>
  assert.ok(vector.distanceTo(expected) < most, `${vector.toArray()}, not ${expected.toArray()}`);

/** Returns a mesh in a separate node of a moved scene. */
function placed(mesh, matrix) {
  const scene = new Group().add(mesh);
  matrix.decompose(mesh.position, mesh.quaternion, mesh.scale);
  scene.updateMatrixWorld(true);
  return mesh;
}

const rotation = new Quaternion().setFromAxisAngle(new Vector3(0.6, 0.8, 0), 1.2);

test("without predictors the shader has no inputs", () => {
  assert.deepEqual(bakedFrame(new Mesh(geometryOf()), []), { defines: {}, uniforms: {} });
});

test("positions and normals are in world space of the file, also under mirroring and stretching nodes", () => {
  for (const scale of [[1, 1, 1], [2, 3, 0.5], [-1, 1, 1], [1e-6, 2e-6, 1e-6]]) {
    const matrix = new Matrix4().compose(new Vector3(5, 6, 7), rotation, new Vector3(...scale));
    const mesh = placed(new Mesh(geometryOf()), matrix);
    const frame = bakedFrame(mesh, PREDICTORS);
    // The squares stay within the range of floats, even for a very small node.
    assert.ok(Math.abs(Math.max(...frame.uniforms.prtNormalToBake.value.elements.map(Math.abs)) - 1) < 1e-12);
    for (let v = 0; v < 3; ++v) {
      const [point, normal] = inShader(mesh, frame, v);
      near(point, new Vector3(...POSITIONS[v]).applyMatrix4(matrix).sub(new Vector3(...ORIGIN)));
      // A normal stays perpendicular to tangents that rotate with the surface, and on its side.
      const along = new Vector3(...NORMALS[v]);
      for (const tangent of [new Vector3(1, 0, 0).cross(along), new Vector3(0, 1, 0).cross(along)]) {
        const rotated = tangent.clone().transformDirection(matrix);
        assert.ok(Math.abs(rotated.dot(normal)) < 1e-6);
      }
      assert.ok(normal.dot(along.clone().transformDirection(matrix)) > 0);
      assert.ok(Math.abs(normal.length() - 1) < 1e-6);
    }
  }
});

test("later transforms of the model do not change the baked frame", () => {
  const mesh = placed(new Mesh(geometryOf()), new Matrix4().makeTranslation(1, 0, 0));
  const frame = bakedFrame(mesh, PREDICTORS);
  const [before] = inShader(mesh, frame, 1);
  mesh.parent.position.set(100, 0, 0);
  mesh.parent.updateMatrixWorld(true);
  near(inShader(mesh, frame, 1)[0], before);
});

test("predictors of one kind need only their own inputs", () => {
  const defines = (predictors) => bakedFrame(new Mesh(geometryOf()), predictors).defines;
  assert.deepEqual(defines([PREDICTORS[0]]), { PRT_PREDICTOR_NORMAL: 1 });
  assert.deepEqual(defines([PREDICTORS[1]]), { PRT_PREDICTOR_POSITION: 1, PRT_PREDICTOR_ORIGIN: "vec3(0.0)" });
});

test("positions far from the origin of their mesh keep their precision", () => {
  const far = new Vector3(1e6, -2e6, 5e5);
  const predictors = [{ kind: "position", origin: far.toArray(), scale: [1, 1, 1] }];
  // The node contains the offset, and the matrix removes it.
  const byNode = placed(new Mesh(geometryOf()), new Matrix4().makeTranslation(far));
  const frame = bakedFrame(byNode, predictors);
  assert.ok(!frame.defines.PRT_BAKED_ATTRIBUTES);
  near(inShader(byNode, frame, 2)[0], new Vector3(...POSITIONS[2]));
  // The attributes are used: a matrix of floats is not precise enough.
  const byAttributes = placed(new Mesh(geometryOf(POSITIONS.map((p) => p.map((x, i) => x + far.getComponent(i))))), new Matrix4());
  const other = bakedFrame(byAttributes, predictors);
  assert.ok(other.defines.PRT_BAKED_ATTRIBUTES);
  near(inShader(byAttributes, other, 2)[0], new Vector3(...POSITIONS[2]));
});

test("vertices without a normal use the normals of their triangles", () => {
  for (const mirror of [1, -1])
    for (const normals of [null, [[0, 0, 1], [0, 0, 0], [0, 0, 1]]]) {
      const mesh = placed(new Mesh(geometryOf(POSITIONS, normals)), new Matrix4().makeScale(mirror, 1, 1));
      const frame = bakedFrame(mesh, PREDICTORS);
      near(inShader(mesh, frame, 1)[1], new Vector3(0, -0.5, 1).normalize());
      if (normals) near(inShader(mesh, frame, 0)[1], new Vector3(0, 0, 1));
    }
  const collapsed = placed(new Mesh(geometryOf([[0, 0, 0], [1, 0, 0], [2, 0, 0]], null)), new Matrix4());
  near(inShader(collapsed, bakedFrame(collapsed, PREDICTORS), 1)[1], new Vector3());
});

test("normals that floats cannot normalise are normalised at load time or replaced by triangle normals", () => {
  const tiny = [0, 1e-30, 0];
  const huge = [0, 0, 1e30];
  for (const [third, expected] of [[tiny, [0, 1, 0]], [huge, [0, 0, 1]], [[NaN, 0, 0], null], [[0, Infinity, 0], null]]) {
    const mesh = placed(new Mesh(geometryOf(POSITIONS, [NORMALS[0], NORMALS[1], third])), new Matrix4());
    const frame = bakedFrame(mesh, PREDICTORS);
    const triangles = new Vector3(0, -0.5, 1).normalize();
    near(inShader(mesh, frame, 2)[1], expected ? new Vector3(...expected) : triangles);
    near(inShader(mesh, frame, 1)[1], new Vector3(...NORMALS[1]));
  }
});

test("positions outside the range of floats are rejected", () => {
  for (const wrong of [NaN, Infinity, 2e9]) {
    const far = [POSITIONS[0], POSITIONS[1], [0, wrong, 0]];
    assert.throws(() => bakedFrame(placed(new Mesh(geometryOf(far)), new Matrix4()), PREDICTORS), /vertex 2 is farther/);
  }
});

test("skinned meshes use the pose of the file, morphed meshes its weights", () => {
  const geometry = geometryOf();
  geometry.setAttribute("skinIndex", new BufferAttribute(new Uint16Array([0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0]), 4));
  geometry.setAttribute("skinWeight", new BufferAttribute(new Float32Array([1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0]), 4));
  geometry.morphAttributes.position = [new BufferAttribute(new Float32Array([0, 0, 0, 0, 4, 0, 0, 0, 0]), 3)];
  geometry.morphTargetsRelative = true;
  const mesh = new SkinnedMesh(geometry);
  mesh.updateMorphTargets();
  mesh.morphTargetInfluences = [0.5];
  const bones = [new Bone(), new Bone()];
  bones[0].position.set(0, 3, 0);
  bones[1].quaternion.setFromAxisAngle(new Vector3(0, 0, 1), Math.PI / 2);
  const scene = new Group().add(mesh, ...bones);
  mesh.position.set(50, 0, 0); // does not move skinned meshes
  scene.updateMatrixWorld(true);
  mesh.bind(new Skeleton(bones, [new Matrix4(), new Matrix4()]), new Matrix4());
  const frame = bakedFrame(mesh, PREDICTORS);
  const origin = new Vector3(...ORIGIN);
  near(inShader(mesh, frame, 0)[0], new Vector3(0, 3, 0).sub(origin));
  near(inShader(mesh, frame, 1)[0], new Vector3(-2, 1, 0).sub(origin)); // (1, 2, 0) rotated
  near(inShader(mesh, frame, 1)[1], new Vector3(0, 0.6, 0.8));
  near(inShader(mesh, frame, 2)[0], new Vector3(-0.5, 2, 0.5).sub(origin)); // half (0, 4, 0.5), half (-1, 0, 0.5)
});
