// A decoder of prtkit files in another language, written from docs/format.md alone:
//   node decode.cjs BAKED SHIPPED
// prints the area-weighted relative L2 error of SHIPPED against BAKED.
const fs = require("fs");

function half(bits) {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (exponent === 0 ? fraction * 2 ** -24 : (1 + fraction / 1024) * 2 ** (exponent - 15));
}

class Glb {
  constructor(path) {
    const file = fs.readFileSync(path);
    const jsonLength = file.readUInt32LE(12);
    this.json = JSON.parse(file.subarray(20, 20 + jsonLength).toString("utf8"));
    this.bin = file.subarray(28 + jsonLength);
  }

  floats(object) {
    const view = this.json.bufferViews[object.bufferView];
    const start = view.byteOffset ?? 0;
    const values = [];
    if (object.componentType === 5131)
      for (let i = 0; i < view.byteLength / 2; ++i) values.push(half(this.bin.readUInt16LE(start + 2 * i)));
    else for (let i = 0; i < view.byteLength / 4; ++i) values.push(this.bin.readFloatLE(start + 4 * i));
    return values;
  }

  accessor(index) {
    const accessor = this.json.accessors[index];
    const view = this.json.bufferViews[accessor.bufferView];
    const components = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 }[accessor.type];
    const [size, read] = {
      5120: [1, (o) => this.bin.readInt8(o)],
      5121: [1, (o) => this.bin.readUInt8(o)],
      5122: [2, (o) => this.bin.readInt16LE(o)],
      5123: [2, (o) => this.bin.readUInt16LE(o)],
      5125: [4, (o) => this.bin.readUInt32LE(o)],
      5126: [4, (o) => this.bin.readFloatLE(o)],
    }[accessor.componentType];
    const largest = { 5120: 127, 5122: 32767 }[accessor.componentType];
    const start = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    const stride = view.byteStride ?? size * components;
    const elements = [];
    for (let i = 0; i < accessor.count; ++i) {
      const element = [];
      for (let c = 0; c < components; ++c) {
        const stored = read(start + i * stride + c * size);
        element.push(accessor.normalized ? Math.max(stored / largest, -1) : stored);
      }
      elements.push(element);
    }
    return elements;
  }

  primitives() {
    return this.json.meshes.flatMap((mesh) => mesh.primitives);
  }
}

function rawVectors(glb, primitive) {
  const { order, channels } = glb.json.extensions.PRTKIT_transfer;
  const dimension = channels * order * order;
  const values = glb.floats(primitive.extensions.PRTKIT_transfer.vectors);
  return Array.from({ length: values.length / dimension }, (_, p) => values.slice(p * dimension, (p + 1) * dimension));
}

function decodedVectors(glb, primitive) {
  const extension = glb.json.extensions.PRTKIT_clustered_pca;
  const dimension = extension.channels * extension.order * extension.order;
  const bases = glb.floats(extension.bases);
  const scales = glb.floats(extension.scales);
  const firstScale = [0];
  for (const m of extension.components) firstScale.push(firstScale.at(-1) + m);
  const row = (r) => bases.slice(r * dimension, (r + 1) * dimension);
  const clusters = glb.accessor(primitive.attributes._PRT_CLUSTER).flat();
  const groups = [];
  while (`_PRT_WEIGHTS_${groups.length}` in primitive.attributes)
    groups.push(glb.accessor(primitive.attributes[`_PRT_WEIGHTS_${groups.length}`]));
  return clusters.map((k, p) => {
    const first = k + firstScale[k];
    const vector = row(first);
    for (let j = 0; j < extension.components[k]; ++j) {
      const weight = scales[firstScale[k] + j] * groups[j >> 2][p][j & 3];
      row(first + 1 + j).forEach((b, i) => (vector[i] += weight * b));
    }
    return vector;
  });
}

/// A third of the triangles' areas at each vertex. The scene's nodes must not move their meshes.
function areas(glb, primitive) {
  const positions = glb.accessor(primitive.attributes.POSITION);
  const indices = glb.accessor(primitive.indices).flat();
  const result = positions.map(() => 0);
  for (let t = 0; t < indices.length; t += 3) {
    const [a, b, c] = indices.slice(t, t + 3).map((i) => positions[i]);
    const u = b.map((v, i) => v - a[i]);
    const v = c.map((w, i) => w - a[i]);
    const cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    for (let corner = 0; corner < 3; ++corner) result[indices[t + corner]] += Math.hypot(...cross) / 6;
  }
  return result;
}

const baked = new Glb(process.argv[2]);
const shipped = new Glb(process.argv[3]);
let error = 0;
let norm = 0;
baked.primitives().forEach((primitive, i) => {
  const weights = areas(baked, primitive);
  const decoded = decodedVectors(shipped, shipped.primitives()[i]);
  rawVectors(baked, primitive).forEach((vector, p) =>
    vector.forEach((value, k) => {
      error += weights[p] * (value - decoded[p][k]) ** 2;
      norm += weights[p] * value ** 2;
    }),
  );
});
console.log(Math.sqrt(error / norm));
