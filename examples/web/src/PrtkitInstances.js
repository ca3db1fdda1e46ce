// Instances of a file that share the transfer of their mesh: one InstancedMesh for each primitive of it, and what lights each.

import { BufferGeometry, InstancedBufferAttribute, InstancedMesh, Matrix4 } from "three";
import { bakedFrame } from "./bakedFrame.js";
import { InstanceFormer, rowsOf } from "./InstanceFormer.js";
import { FACTORS } from "./instanceModes.js";
import { evenRotation, factorsOf, movingNodes, placesOf } from "./instanceNodes.js";
import { clustersTextureOf, constantsTextureOf, tablesOf, widthFor } from "./tables.js";
import { expect, INSTANCES } from "./wholeExtension.js";

const MOST_TEXELS = 2 ** 26; // 1 GB
const IN_PLACE = new Matrix4();

/** The same attributes as `source`, for others of instances beside them. */
function shared(source) {
  const geometry = new BufferGeometry();
  geometry.setIndex(source.index);
  for (const [name, attribute] of Object.entries(source.attributes)) geometry.setAttribute(name, attribute);
  geometry.userData = source.userData;
  return geometry;
}

/** Numbers of the clusters of all vertices. */
function* clustersOfVertices({ attributes: { position, prt_words_0: words, prt_cluster: cluster } }, { clusterBits }) {
  for (let v = 0; v < position.count; ++v)
    yield words ? words.array[v * words.itemSize] & (2 ** clusterBits - 1) : cluster.getX(v);
}

/** Guides as the shader of instances has them, which does not take their origin off before. */
function originOf(guides) {
  const { origin } = guides.find(({ kind }) => kind === "position") ?? {};
  const number = (value) => (Number.isInteger(value) ? value.toFixed(1) : String(value));
  return origin ? { PRT_GUIDE_ORIGIN: `vec3(${origin.map((value) => number(Math.fround(value))).join(", ")})` } : {};
}

/** Nodes that draw a mesh together: those that stay where they are, and each that animations move alone. */
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

/** The objects of nodes, by their numbers. */
function objectsOf(gltf, { associations }) {
  const objects = new Map();
  gltf.scene.traverse((object) => {
    const { nodes } = associations.get(object) ?? {};
    if (nodes !== undefined && !objects.has(nodes)) objects.set(nodes, object);
  });
  return objects;
}

/** What is drawn of a group: the matrix and the factors of each instance, and what turns them into the world. */
async function instancesOf({ nodes, moves }, objects, factors, boxes, parser) {
  const count = factors.length / FACTORS;
  const instances = [];
  for (const node of nodes) {
    const object = objects.get(node.node);
    if (!object) continue; // of another scene
    const places = await placesOf(node, parser, count - node.first);
    places.forEach((place, i) => {
      const world = object.matrixWorld.clone().multiply(place);
      const rotation = evenRotation(world);
      expect(rotation, `node ${node.node} draws an instance that it mirrors or scales unevenly`, INSTANCES);
      const own = factors.subarray(FACTORS * (node.first + i), FACTORS * (node.first + i + 1));
      instances.push({ matrix: moves ? place : world, rotation, factors: own, box: boxes[node.box] });
    });
  }
  return instances;
}

export class PrtkitInstances {
  /**
   * The instances of `nodes` (takeInstancesAside) in `gltf`, whose matrices are those of the file. `model`: PrtkitModel of it;
   * `bytes`: of the factors; `definesOf`: of vertexTransfer.js.
   */
  static async of(nodes, { gltf, parser, model, extension, bytes, definesOf }) {
    const factors = factorsOf(extension, bytes);
    const objects = objectsOf(gltf, parser);
    const groups = [];
    let count = 0;
    for (const group of groupsOf(nodes, parser.json)) {
      const instances = await instancesOf(group, objects, factors, extension.boxes, parser);
      count += instances.length;
      expect(count <= extension.count, "more instances are drawn than have factors", INSTANCES);
      if (instances.length === 0) continue;
      const loaded = await parser.getDependency("mesh", group.mesh);
      const primitives = (loaded.isGroup ? loaded.children : [loaded]).map((mesh, primitive) => ({ mesh, primitive }));
      const parent = group.moves ? objects.get(group.nodes[0].node) : gltf.scene;
      groups.push({ ...group, instances, primitives, parent });
    }
    return new PrtkitInstances(model, groups, { parser, definesOf, bytesPerInstance: bytes.byteLength / extension.count });
  }

  constructor(model, groups, { parser, definesOf, bytesPerInstance }) {
    const { clusters } = model;
    /** Instances that are drawn, and bytes of what a file has of each. */
    this.count = 0;
    this.bytesPerInstance = bytesPerInstance;
    this.meshes = [];
    this.transfers = new Map(); // by mesh
    const copied = new Set();
    for (const group of groups) {
      group.primitives = group.primitives.filter(({ mesh }) => mesh.isMesh && definesOf(mesh.geometry));
      const numbers = group.primitives.flatMap(({ mesh }) => [...new Set(clustersOfVertices(mesh.geometry, clusters))]);
      group.rows = rowsOf(clusters, numbers);
    }
    const all = groups.flatMap(({ instances, rows }) => instances.map((instance) => ({ ...instance, rows: rows.list })));
    this.former = new InstanceFormer(clusters, model.rows, all);
    const { size } = this.former;
    expect(size <= MOST_TEXELS, `constants of ${all.length} instances would take ${Math.round((16 * size) / 1e6)} MB`, INSTANCES);
    this.width = widthFor(size);
    this.constantsTexture = constantsTextureOf(size, this.width);
    this.clustersTextures = []; // each mesh has but the rows of its own clusters
    const tables = { ...tablesOf(this.width), PRT_INSTANCES: 1 };
    for (const group of groups) {
      const number = group.instances.length;
      const table = this.former.table(this.count, number).map((array) => new InstancedBufferAttribute(array, 4));
      this.count += number;
      let matrices = null;
      const clustersTexture = clustersTextureOf({ ...clusters, firstRows: group.rows.begins }, this.width);
      const uniforms = { prt_constants: { value: this.constantsTexture }, prt_clusters: { value: clustersTexture } };
      this.clustersTextures.push(clustersTexture);
      for (const { mesh, primitive } of group.primitives) {
        const defines = definesOf(mesh.geometry);
        const geometry = copied.has(mesh.geometry) ? shared(mesh.geometry) : mesh.geometry;
        copied.add(mesh.geometry);
        table.forEach((attribute, i) => geometry.setAttribute(`prt_instance_${i}`, attribute));
        const drawn = new InstancedMesh(geometry, mesh.material, number);
        if (matrices) drawn.instanceMatrix = matrices;
        else group.instances.forEach(({ matrix }, i) => drawn.setMatrixAt(i, matrix));
        matrices = drawn.instanceMatrix;
        drawn.name = mesh.name;
        Object.assign(drawn.userData, mesh.userData);
        group.parent.add(drawn);
        parser.associations.set(drawn, { meshes: group.mesh, primitives: primitive });
        this.meshes.push(drawn);
        const frame = bakedFrame(drawn, atOrigin(clusters.guides), IN_PLACE);
        this.transfers.set(drawn, { uniforms, defines: { ...defines, ...frame.defines, ...tables, ...originOf(clusters.guides) } });
      }
    }
    /** On the device, on average. */
    this.constantsBytesPerInstance = this.count > 0 ? (16 * size) / this.count : 0;
    this.renderers = new WeakSet(); // whose textures are large enough
  }

  /** What a mesh is lit by, where it is one of these. */
  transferOf(mesh) {
    return this.transfers.get(mesh);
  }

  /** The constants of all of them, for coefficients in the frame of the bake. */
  form(sky, suns) {
    this.former.form(sky, suns, this.constantsTexture.image.data);
    this.constantsTexture.needsUpdate = true;
  }

  /** Throws where a device has no textures as wide as the constants take. */
  checkSize(renderer) {
    if (this.renderers.has(renderer)) return;
    const { maxTextureSize } = renderer.capabilities;
    const { width, height } = this.constantsTexture.image;
    if (Math.max(width, height) > maxTextureSize)
      throw new Error(`prtkit: constants of ${this.count} instances want a texture of ${width} x ${height}, and this device has ${maxTextureSize}`);
    this.renderers.add(renderer);
  }

  /** Frees the tables on the device. */
  dispose() {
    this.constantsTexture.dispose();
    for (const texture of this.clustersTextures) texture.dispose();
  }
}

/** Guides whose places are seen from the origin of the mesh. */
function atOrigin(guides) {
  return guides.map((guide) => (guide.kind === "position" ? { ...guide, origin: [0, 0, 0] } : guide));
}
