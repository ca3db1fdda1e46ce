// An independent decoder of prtkit files in JavaScript, written from docs/format.md only:
//   node decode.cjs BAKED SHIPPED [NODE_MODULES]
// Prints the area-weighted relative L2 error of SHIPPED against BAKED, and its expected lit_rms under natural
// light. Lightmaps need the PNG reader pngjs in NODE_MODULES.
const fs = require("fs");
const { resolve } = require("path");

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

  bytes(view) {
    const { byteOffset = 0, byteLength } = this.json.bufferViews[view];
    return this.bin.subarray(byteOffset, byteOffset + byteLength);
  }

  numbers(object) {
    const bytes = this.bytes(object.bufferView);
    return Array.from({ length: bytes.length / 4 }, (_, i) => bytes.readUInt32LE(4 * i));
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
      5121: [1, (o) => this.bin.readUInt8(o)],
      5123: [2, (o) => this.bin.readUInt16LE(o)],
      5125: [4, (o) => this.bin.readUInt32LE(o)],
      5126: [4, (o) => this.bin.readFloatLE(o)],
    }[accessor.componentType];
    const start = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    const stride = view.byteStride ?? size * components;
    const elements = [];
    for (let i = 0; i < accessor.count; ++i) {
      const element = [];
      for (let c = 0; c < components; ++c) element.push(read(start + i * stride + c * size));
      elements.push(element);
    }
    return elements;
  }

  /// Returns the set of these receivers; undefined if there is none.
  set(receivers) {
    return this.json.extensions.PRTKIT_transfer.sets.find((set) => set.receivers === receivers);
  }

  primitives() {
    return this.json.meshes.flatMap((mesh) => mesh.primitives);
  }
}

/// Returns the number of values of a term, and of a transfer vector.
const columnsOf = (term, order) => (term.kind === "lamp" ? 1 : order * order);
const dimensionOf = ({ order, terms }) =>
  terms.reduce((sum, term) => sum + term.channels * columnsOf(term, order), 0);

/// Returns the vectors [receivers][S] of a buffer view.
function rawVectors(glb, set, view) {
  const dimension = dimensionOf(set);
  const values = glb.floats(view);
  return Array.from({ length: values.length / dimension }, (_, p) => values.slice(p * dimension, (p + 1) * dimension));
}

/// Reads bits of bytes, lowest first.
class Bits {
  constructor(bytes) {
    this.bytes = bytes;
    this.position = 0;
  }
  read(width) {
    let value = 0;
    for (let b = 0; b < width; ++b, ++this.position)
      value += ((this.bytes[this.position >> 3] >> (this.position & 7)) & 1) * 2 ** b;
    return value;
  }
}

/// Returns the numbers of an arithmetically coded buffer view, row by row.
function codedRows(glb, code, rows) {
  const bytes = [...glb.bytes(code.bufferView)];
  const nextByte = () => {
    if (bytes.length === 0) throw new Error("the coded rows end too early");
    return bytes.shift();
  };
  if (code.drops.length === 0 || rows === 0) return Array.from({ length: rows }, () => []);
  let range = 2 ** 32 - 1;
  let value = 0;
  for (let i = 0; i < 4; ++i) value = 256 * value + nextByte();
  const bit = (bound) => {
    const one = value < bound;
    if (!one) value -= bound;
    range = one ? bound : range - bound;
    for (; range < 2 ** 24; range *= 256) value = 256 * value + nextByte();
    return one ? 1 : 0;
  };
  const plain = (count) => Array.from({ length: count }, () => bit(Math.floor(range / 2))).reduce((v, b) => 2 * v + b, 0);
  const models = {};
  const modelled = (...name) => {
    const model = (models[name] ??= { p: 32768, n: 0 });
    const one = bit(Math.floor(range / 65536) * model.p);
    model.p = Math.min(65472, Math.max(64, model.p + Math.trunc((65536 * one - model.p) / (model.n + 2))));
    model.n = Math.min(model.n + 1, 62);
    return one;
  };
  const number = (w) => {
    if (w <= 0 || modelled("zero", w)) return 0;
    const sign = plain(1) ? -1 : 1;
    let b = 0;
    while (b < w - 1 && modelled("longer", w, b)) ++b;
    if (b === 0) return sign;
    const highest = 2 + modelled("second", w, b);
    return sign * (highest * 2 ** (b - 1) + plain(b - 1));
  };
  return Array.from({ length: rows }, () => {
    const level = plain(4);
    return code.drops.map((drop) => number(level - drop));
  });
}

/// Returns a function that returns the step of axis i in cluster k of coded bases.
function stepsOf(glb, { components, bases: { step, steps } }) {
  if (!steps) return () => step;
  const groups = steps.axes.flatMap((count, group) => Array(count).fill(group));
  const exponents = codedRows(glb, steps, components.length);
  return (k, i) => steps.least * 2 ** exponents[k][groups[i]];
}

/// Returns for each cluster its mean, the rows of its predictors and its directions.
function clusterRows(glb, set) {
  const dimension = dimensionOf(set);
  const predicted = 3 * (set.predictors ?? []).length;
  const count = set.components.reduce((sum, m) => sum + 1 + predicted + m, 0);
  let rows;
  if ("values" in set.bases) {
    const { origin, scales, axes, values, units } = set.bases;
    const step = stepsOf(glb, set);
    const unit = units ? glb.floats(units) : Array(dimension).fill(1);
    const start = glb.floats(origin);
    const scale = glb.floats(scales);
    const axis = codedRows(glb, axes, scale.length);
    const cluster = set.components.flatMap((m, k) => Array(1 + predicted + m).fill(k));
    const isMean = set.components.flatMap((m) => [true, ...Array(predicted + m).fill(false)]);
    const factor = set.components.flatMap((m) => [...Array(1 + predicted).fill(1), ...Array(m).fill(2)]);
    rows = codedRows(glb, values, count).map((value, r) => {
      const row = isMean[r] ? [...start] : Array(dimension).fill(0);
      value.forEach((v, i) => {
        for (let a = 0; a < dimension; ++a) row[a] += factor[r] * step(cluster[r], i) * scale[i] * v * axis[i][a] * unit[a];
      });
      return row;
    });
  } else {
    const floats = glb.floats(set.bases);
    rows = Array.from({ length: count }, (_, r) => floats.slice(r * dimension, (r + 1) * dimension));
  }
  let next = 0;
  return set.components.map((m) => rows.slice(next, (next += 1 + predicted + m)));
}

/// Returns the coordinates of every vertex of a primitive in the predictors. The scene's nodes must not
/// transform their meshes.
function predictorCoordinates(glb, set, primitive) {
  const predictors = set.predictors ?? [];
  const normals = glb.accessor(primitive.attributes.NORMAL);
  return glb.accessor(primitive.attributes.POSITION).map((position, p) =>
    predictors.flatMap(({ kind, origin }) => {
      if (kind === "position") return position.map((value, i) => value - origin[i]);
      const length = Math.hypot(...normals[p]);
      return normals[p].map((value) => (length > 0 ? value / length : 0));
    }),
  );
}

/// Returns a function that decodes cluster and weights from the bytes of a receiver's words.
function packedCodes(glb, { components, packing }) {
  const widths = new Bits(glb.bytes(packing.bufferView));
  const bits = components.map((m) => Array.from({ length: m }, () => widths.read(4) + 1));
  return (bytes) => {
    const words = new Bits(bytes);
    const cluster = words.read(packing.clusterBits);
    const weights = bits[cluster].map((width) => (2 * words.read(width) - (2 ** width - 1)) / (2 ** width - 1));
    return { cluster, weights };
  };
}

/// Returns cluster and weights of every vertex of a primitive.
function vertexCodes(glb, set, primitive) {
  const groups = [];
  while (`_PRT_WEIGHTS_${groups.length}` in primitive.attributes)
    groups.push(glb.accessor(primitive.attributes[`_PRT_WEIGHTS_${groups.length}`]));
  if (!("packing" in set)) {
    const clusters = glb.accessor(primitive.attributes._PRT_CLUSTER).flat();
    return clusters.map((k, p) => ({
      cluster: k,
      weights: Array.from({ length: set.components[k] }, (_, j) => groups[j >> 2][p][j & 3]),
    }));
  }
  const codeOf = packedCodes(glb, set);
  return groups[0].map((_, p) => codeOf(groups.flatMap((group) => group[p])));
}

/// Returns the bytes of the words of every texel, one map after the other.
function texelBytes(glb, { maps }) {
  const { PNG } = require(resolve(process.argv[4], "pngjs"));
  return maps.flatMap(({ width, height, images }) => {
    const words = images.map((i) => {
      const { bufferView, mimeType } = glb.json.images[i];
      const image = PNG.sync.read(glb.bytes(bufferView));
      if (mimeType !== "image/png" || image.width !== width || image.height !== height || image.depth !== 8 || !image.alpha)
        throw new Error(`image ${i} is not a PNG of words`);
      return image.data;
    });
    return Array.from({ length: width * height }, (_, t) => words.flatMap((data) => [...data.subarray(4 * t, 4 * t + 4)]));
  });
}

/// Returns the mean of a cluster plus its other rows multiplied by weights.
function combined(rows, weights) {
  const vector = [...rows[0]];
  weights.forEach((w, j) => rows[1 + j].forEach((b, i) => (vector[i] += w * b)));
  return vector;
}

function decodedVectors(glb, primitive) {
  const set = glb.set("vertices");
  const rows = clusterRows(glb, set);
  const coordinates = predictorCoordinates(glb, set, primitive);
  const scales = (set.predictors ?? []).flatMap(({ scale }) => scale);
  const centers = set.centers ? codedRows(glb, set.centers, rows.length) : rows.map(() => []);
  return vertexCodes(glb, set, primitive).map(({ cluster, weights }, p) => {
    const predicted = scales.map((scale, i) => scale * coordinates[p][i] - centers[cluster][i]);
    return combined(rows[cluster], [...predicted, ...weights]);
  });
}

/// Returns a third of the triangles' areas at each vertex. The scene's nodes must not transform their meshes.
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

/// Returns area, vector and decoded vector of every vertex.
function vertices(baked, shipped) {
  return baked.primitives().flatMap((primitive, i) => {
    const weights = areas(baked, primitive);
    const decoded = decodedVectors(shipped, shipped.primitives()[i]);
    const raw = rawVectors(baked, baked.set("vertices"), primitive.extensions.PRTKIT_transfer.vectors);
    return raw.map((vector, p) => ({ area: weights[p], vector, decoded: decoded[p] }));
  });
}

/// Returns the decoded vectors of every texel that is a receiver. All texels are decoded.
function texels(baked, shipped) {
  const set = shipped.set("texels");
  const rows = clusterRows(shipped, set);
  const decoded = texelBytes(shipped, set)
    .map(packedCodes(shipped, set))
    .map(({ cluster, weights }) => combined(rows[cluster], weights));
  const raw = baked.set("texels");
  const numbers = baked.numbers(raw.texels);
  const sizes = baked.floats(raw.areas);
  return rawVectors(baked, raw, raw.vectors).map((vector, p) => ({ area: sizes[p], vector, decoded: decoded[numbers[p]] }));
}

const baked = new Glb(process.argv[2]);
const shipped = new Glb(process.argv[3]);
const ofTexels = baked.set("texels");
const { order, terms } = ofTexels ?? baked.set("vertices");
const channels = Math.max(...terms.map((term) => term.channels));

/// Returns E[ a·b ] of the light in band l on two terms under natural light: docs/math.md, section 4.
function power(l, kindA, kindB) {
  const falling = (p, fall) => (l === 0 ? 1 : p * l ** -fall);
  if (terms.filter(({ kind }) => kind !== "lamp").length === 1) return falling(0.28, 0.6);
  return falling(0.24, 0.85) + (kindA === "direct" || kindB === "direct" ? 0.05 : 0.1);
}

/// Returns a vector by colour and term: [colours][terms][columns].
function byColor(vector) {
  return Array.from({ length: channels }, (_, c) => {
    let at = 0;
    return terms.map((term) => {
      const columns = columnsOf(term, order);
      const from = at + Math.min(c, term.channels - 1) * columns;
      at += term.channels * columns;
      return vector.slice(from, from + columns);
    });
  });
}

/// Returns the sum of squares of a vector, with a grey term counted for each colour, its expected square of light, and
/// the sums of squares by lamp.
function costs(vector) {
  let squares = 0;
  let lit = 0;
  const byLamps = new Map();
  for (const of of byColor(vector))
    terms.forEach((a, p) =>
      of[p].forEach((value, i) => {
        squares += value ** 2;
        if (a.kind === "lamp") {
          byLamps.set(p, (byLamps.get(p) ?? 0) + value ** 2); // each lamp separately, at its own strength
          return;
        }
        terms.forEach((b, q) => {
          if (b.kind !== "lamp") lit += value * of[q][i] * power(Math.floor(Math.sqrt(i)), a.kind, b.kind);
        });
      }),
    );
  return [squares, lit, byLamps];
}

const sums = { error: 0, norm: 0, litError: 0, litNorm: 0 };
const lamps = new Map(); // by term: its error and norm
for (const { area, vector, decoded } of ofTexels ? texels(baked, shipped) : vertices(baked, shipped)) {
  const [error, litError, lampError] = costs(vector.map((value, k) => value - decoded[k]));
  const [norm, litNorm, lampNorm] = costs(vector);
  sums.error += area * error;
  sums.norm += area * norm;
  sums.litError += area * litError;
  sums.litNorm += area * litNorm;
  for (const [lamp, square] of lampNorm) {
    const sum = lamps.get(lamp) ?? { error: 0, norm: 0 };
    sum.error += area * lampError.get(lamp);
    sum.norm += area * square;
    lamps.set(lamp, sum);
  }
}
// All lamps together have the weight of the sky, and equal weights among each other, if both have light.
const shining = [...lamps.values()].filter(({ norm }) => norm > 0);
const all = sums.litNorm > 0 ? sums.litNorm : shining.reduce((sum, { norm }) => sum + norm, 0);
for (const { error, norm } of shining) {
  const scale = all / (norm * shining.length);
  sums.litError += scale * error;
  sums.litNorm += scale * norm;
}
console.log(Math.sqrt(sums.error / sums.norm), Math.sqrt(sums.litError / sums.litNorm));
