// Instances of a file that share the transfer of their mesh: one InstancedMesh for each of its primitives,
// and their light.

import { BufferGeometry, InstancedBufferAttribute, InstancedMesh, Matrix4 } from "three";
import { bakedFrame } from "./bakedFrame.js";
import { InstanceRelighter, rowsOf } from "./InstanceRelighter.js";
import { FACTORS } from "./instanceModes.js";
import { evenRotation, factorsOf, lampLightOf, movingNodes, matricesOf } from "./instanceNodes.js";
import { clustersTextureOf, constantsTextureOf, tablesOf, widthFor } from "./tables.js";
import { expect, INSTANCES } from "./wholeExtension.js";

const MOST_TEXELS = 2 ** 26; // 1 GB
const IN_PLACE = new Matrix4();

/** Returns a geometry with the attributes of `source`, to which other instance attributes can be added. */
function shared(source) {
  const geometry = new BufferGeometry();
  geometry.setIndex(source.index);
  for (const [name, attribute] of Object.entries(source.attributes)) geometry.setAttribute(name, attribute);
  geometry.userData = source.userData;
  return geometry;
}

/** Yields the indices of the clusters of all vertices. */
function* clustersOfVertices({ attributes: { position, prt_words_0: words, prt_cluster: cluster } }, { clusterBits }) {
  for (let v = 0; v < position.count; ++v)
    yield words ? words.array[v * words.itemSize] & (2 ** clusterBits - 1) : cluster.getX(v);
}

/** Returns the defines for predictors in the shader of instances, which subtracts their origin itself. */
function originOf(predictors) {
  const { origin } = predictors.find(({ kind }) => kind === "position") ?? {};
  const number = (value) => (Number.isInteger(value) ? value.toFixed(1) : String(value));
  return origin ? { PRT_PREDICTOR_ORIGIN: `vec3(${origin.map((value) => number(Math.fround(value))).join(", ")})` } : {};
}

/** Groups the nodes that draw a mesh together: static nodes in one group, and each animated node separately. */
function groupsOf(nodes, json) {
  const moving = movingNodes(json);
  const groups = new Map();
  for (const node of nodes) {
    const key = moving.has(node.node) ? `node ${node.node}` : `mesh ${node.mesh}`;
    if (!groups.has(key)) groups.set(key, { mesh: node.mesh, moves: moving.has(node.node), nodes: [] });
    groups.get(key).nodes.push(node);
  }
  return [...groups.values()];
}

/** Returns the objects of nodes by node index. */
function objectsOf(gltf, { associations }) {
  const objects = new Map();
  gltf.scene.traverse((object) => {
    const { nodes } = associations.get(object) ?? {};
    if (nodes !== undefined && !objects.has(nodes)) objects.set(nodes, object);
  });
  return objects;
}

/** Returns the instances of a group: matrix and factors of each, and its rotation to the world. */
async function instancesOf({ nodes, moves }, objects, { factors, lamps }, boxes, parser) {
  const count = factors.length / FACTORS;
  const lampNumbers = lamps.length / count;
  const instances = [];
  for (const node of nodes) {
    const object = objects.get(node.node);
    if (!object) continue; // in a different scene
    const matrices = await matricesOf(node, parser, count - node.first);
    matrices.forEach((matrix, i) => {
      const world = object.matrixWorld.clone().multiply(matrix);
      const rotation = evenRotation(world);
      expect(rotation, `node ${node.node} mirrors an instance or scales it non-uniformly`, INSTANCES);
      const own = factors.subarray(FACTORS * (node.first + i), FACTORS * (node.first + i + 1));
      const ownLamps = lamps.subarray(lampNumbers * (node.first + i), lampNumbers * (node.first + i + 1));
      instances.push({ matrix: moves ? matrix : world, rotation, factors: own, lamps: ownLamps, box: boxes[node.box] });
    });
  }
  return instances;
}

export class PrtkitInstances {
  /**
   * Creates the instances of `nodes` (takeInstancesAside) in `gltf`, whose matrices are those of the file.
   * `model`: its PrtkitModel; `bytes`: the factors; `lampBytes`: the light of lamps, undefined without;
   * `definesOf`: see vertexTransfer.js.
   */
  static async of(nodes, { gltf, parser, model, extension, bytes, lampBytes, definesOf }) {
    const light = { factors: factorsOf(extension, bytes), lamps: lampLightOf(extension, model.lamps.length, lampBytes) };
    const objects = objectsOf(gltf, parser);
    const groups = [];
    let count = 0;
    for (const group of groupsOf(nodes, parser.json)) {
      const instances = await instancesOf(group, objects, light, extension.boxes, parser);
      count += instances.length;
      expect(count <= extension.count, "there are more instances than factors", INSTANCES);
      if (instances.length === 0) continue;
      const loaded = await parser.getDependency("mesh", group.mesh);
      const primitives = (loaded.isGroup ? loaded.children : [loaded]).map((mesh, primitive) => ({ mesh, primitive }));
      const parent = group.moves ? objects.get(group.nodes[0].node) : gltf.scene;
      groups.push({ ...group, instances, primitives, parent });
    }
    return new PrtkitInstances(model, groups, { parser, definesOf, bytesPerInstance: (bytes.byteLength + (lampBytes?.byteLength ?? 0)) / extension.count });
  }

  constructor({ clusters, rows }, groups, { parser, definesOf, bytesPerInstance }) {
    /** Bytes per instance in a file. */
    this.bytesPerInstance = bytesPerInstance;
    for (const group of groups) {
      const lit = group.primitives.filter(({ mesh }) => mesh.isMesh && definesOf(mesh.geometry));
      group.rows = rowsOf(clusters, lit.flatMap(({ mesh }) => [...new Set(clustersOfVertices(mesh.geometry, clusters))]));
    }
    const all = groups.flatMap((group) => group.instances.map((instance) => ({ ...instance, rows: group.rows.list })));
    /** Instances that are drawn. */
    this.count = all.length;
    const size = 3 * all.reduce((sum, instance) => sum + instance.rows.length, 0);
    expect(size <= MOST_TEXELS, `constants of ${all.length} instances need ${Math.round((16 * size) / 1e6)} MB`, INSTANCES);
    /** Bytes of constants on the device, on average. */
    this.constantsBytesPerInstance = this.count > 0 ? (16 * size) / this.count : 0;
    this.relighter = new InstanceRelighter(clusters, rows, all);
    this.width = widthFor(size);
    this.constantsTexture = constantsTextureOf(size, this.width);
    this.clustersTextures = []; // each mesh has only the rows of its clusters
    this.meshes = [];
    this.transfers = new Map(); // by mesh
    this.renderers = new WeakSet(); // renderers whose textures are large enough
    const drawn = new Set(); // geometries
    let first = 0;
    for (const group of groups) {
      this.add(group, first, { clusters, drawn, definesOf, parser });
      first += group.instances.length;
    }
  }

  /** Draws a group; its instances start at `first`. */
  add({ mesh: number, instances, primitives, parent, rows }, first, { clusters, drawn, definesOf, parser }) {
    const clustersTexture = clustersTextureOf({ ...clusters, firstRows: rows.begins }, this.width);
    this.clustersTextures.push(clustersTexture);
    const uniforms = { prt_constants: { value: this.constantsTexture }, prt_clusters: { value: clustersTexture } };
    const own = { ...tablesOf(this.width), PRT_INSTANCES: 1, ...originOf(clusters.predictors) };
    const table = this.relighter.table(first, instances.length).map((array) => new InstancedBufferAttribute(array, 4));
    let matrices = null; // shared by all primitives
    for (const { mesh, primitive } of primitives) {
      if (!mesh.isMesh) continue; // points and lines
      const defines = definesOf(mesh.geometry);
      const geometry = drawn.has(mesh.geometry) ? shared(mesh.geometry) : mesh.geometry;
      drawn.add(mesh.geometry);
      table.forEach((attribute, i) => geometry.setAttribute(`prt_instance_${i}`, attribute));
      const instanced = new InstancedMesh(geometry, mesh.material, instances.length);
      if (matrices) instanced.instanceMatrix = matrices;
      else instances.forEach(({ matrix }, i) => instanced.setMatrixAt(i, matrix));
      matrices = instanced.instanceMatrix;
      instanced.name = mesh.name;
      Object.assign(instanced.userData, mesh.userData);
      parent.add(instanced);
      parser.associations.set(instanced, { meshes: number, primitives: primitive });
      this.meshes.push(instanced);
      if (!defines) continue;
      const frame = bakedFrame(instanced, atOrigin(clusters.predictors), IN_PLACE);
      this.transfers.set(instanced, { uniforms, defines: { ...defines, ...frame.defines, ...own } });
    }
  }

  /** Returns the transfer of a mesh; undefined for other meshes. */
  transferOf(mesh) {
    return this.transfers.get(mesh);
  }

  /** Computes the constants of all instances from coefficients in the space of the bake; see lightColumns. */
  update(sky, suns, strengths) {
    this.relighter.update(sky, suns, strengths, this.constantsTexture.image.data);
    this.constantsTexture.needsUpdate = true;
  }

  /** Throws if the device does not support textures as wide as the constants need. */
  checkSize(renderer) {
    if (this.renderers.has(renderer)) return;
    const { maxTextureSize } = renderer.capabilities;
    const { width, height } = this.constantsTexture.image;
    if (Math.max(width, height) > maxTextureSize)
      throw new Error(`prtkit: constants of ${this.count} instances need a texture of ${width} x ${height} texels; this device supports at most ${maxTextureSize}`);
    this.renderers.add(renderer);
  }

  /** Frees the tables on the device. */
  dispose() {
    this.constantsTexture.dispose();
    for (const texture of this.clustersTextures) texture.dispose();
  }
}

/** Returns predictors whose positions are relative to the origin of the mesh. */
function atOrigin(predictors) {
  return predictors.map((predictor) => (predictor.kind === "position" ? { ...predictor, origin: [0, 0, 0] } : predictor));
}
