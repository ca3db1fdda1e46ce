// shaders/prt_exit_radiance.glsl in three's node language, for WebGPURenderer: for vertices and texels.

import {
  attribute,
  Fn,
  float,
  If,
  ivec2,
  Loop,
  normalGeometry,
  positionGeometry,
  textureLoad,
  uint,
  uniform,
  varying,
  vec3,
} from "three/tsl";
import { Matrix3, Matrix4 } from "three/webgpu";
import { TABLES } from "./tables.js";

const ROW_BITS = Math.log2(TABLES.PRT_TEXTURE_WIDTH);

/** Entry `i`, an unsigned integer, of a table of PrtkitModel. */
const entry = (table, i) =>
  textureLoad(table, ivec2(i.bitAnd(uint(TABLES.PRT_TEXTURE_WIDTH - 1)), i.shiftRight(uint(ROW_BITS))));

/** Returns a function that reads `width` bits of words from bit `at`; they may cross two words. */
function bitsOf(words) {
  const word = (i) => words.reduce((chosen, one, k) => (k === 0 ? one : i.equal(uint(k)).select(one, chosen)), null);
  return (at, width) => {
    const shift = at.bitAnd(uint(31));
    const low = word(at.shiftRight(uint(5))).shiftRight(shift);
    const high = word(at.shiftRight(uint(5)).add(uint(1))).shiftLeft(uint(32).sub(shift).bitAnd(uint(31)));
    const both = words.length > 1 ? shift.add(width).greaterThan(uint(32)).select(low.bitOr(high), low) : low;
    return both.bitAnd(uint(1).shiftLeft(width).sub(uint(1)));
  };
}

const NO_PREDICTORS = { rows: 0, of: null };

/**
 * Returns the radiance of the packed `words()`. `predictors`: { rows, of }: number of rows per cluster, and a
 * function that returns their contribution to the mean, given the cluster's first row.
 */
export function radianceOfWords({ constantsTexture, clustersTexture }, words, clusterBits, predictors = NO_PREDICTORS) {
  return Fn(() => {
    const bits = bitsOf(words());
    const cluster = entry(clustersTexture, bits(uint(0), uint(clusterBits))).toVar();
    const first = cluster.x;
    const radiance = vec3(entry(constantsTexture, first).rgb).toVar();
    if (predictors.of) radiance.addAssign(predictors.of(first));
    const at = uint(clusterBits).toVar();
    Loop({ start: uint(0), end: cluster.y, type: "uint", condition: "<" }, ({ i }) => {
      const widths = i.lessThan(uint(8)).select(cluster.z, cluster.w);
      const width = widths.shiftRight(i.bitAnd(uint(7)).mul(uint(4))).bitAnd(uint(15)).add(uint(1)).toVar();
      const row = first.add(uint(1 + predictors.rows)).add(i);
      radiance.addAssign(entry(constantsTexture, row).rgb.mul(float(bits(at, width))));
      at.addAssign(width);
    });
    return radiance;
  })();
}

/** Returns the radiance for weights in vectors of four and a separate cluster. */
function radianceOfWeights({ constantsTexture, clustersTexture }, vectors, predictors) {
  return Fn(() => {
    const cluster = entry(clustersTexture, attribute("prt_cluster", "uint")).toVar();
    const first = cluster.x;
    const radiance = vec3(entry(constantsTexture, first).rgb).toVar();
    if (predictors.of) radiance.addAssign(predictors.of(first));
    for (let j = 0; j < 4 * vectors; ++j)
      If(uint(j).lessThan(cluster.y), () => {
        const weight = attribute(`prt_weights_${j >> 2}`, "vec4")["xyzw"[j & 3]];
        radiance.addAssign(entry(constantsTexture, first.add(uint(1 + predictors.rows + j))).rgb.mul(weight));
      });
    return radiance;
  })();
}

// Uniforms by the material being drawn: the nodes are shared by the whole model.
const ofMaterial = (value, name) => uniform(value).onObjectUpdate(({ material }) => material._transfer.uniforms[name].value);
const toBake = ofMaterial(new Matrix4(), "prtToBake");
const normalToBake = ofMaterial(new Matrix3(), "prtNormalToBake");

/** Returns position and normal of a vertex in the space of the bake, as in transferVertex.glsl. */
function bakedFrameOf(defines) {
  if (defines.PRT_BAKED_ATTRIBUTES) return { point: attribute("prt_baked_position", "vec3"), normal: attribute("prt_baked_normal", "vec3") };
  const rotated = normalToBake.mul(normalGeometry);
  return { point: toBake.mul(positionGeometry).xyz, normal: rotated.mul(rotated.dot(rotated).max(1e-30).inverseSqrt()) };
}

function predictorsOf({ constantsTexture }, defines) {
  const { point, normal } = bakedFrameOf(defines);
  const vectors = [...(defines.PRT_PREDICTOR_NORMAL ? [normal] : []), ...(defines.PRT_PREDICTOR_POSITION ? [point] : [])];
  if (vectors.length === 0) return NO_PREDICTORS;
  const coordinates = vectors.flatMap((vector) => [vector.x, vector.y, vector.z]);
  const of = (first) =>
    coordinates
      .map((x, g) => entry(constantsTexture, first.add(uint(1 + g))).rgb.mul(x))
      .reduce((sum, added) => sum.add(added));
  return { rows: coordinates.length, of };
}

const TYPES = ["uint", "uvec2", "uvec3", "uvec4"];

/** Returns the words of a vertex, from the attributes of vertexWeights.js. */
function wordsOfVertex(count) {
  const inAttribute = (i) => Math.min(4, count - 4 * i);
  return Array.from({ length: count }, (_, j) => {
    const size = inAttribute(j >> 2);
    const words = attribute(`prt_words_${j >> 2}`, TYPES[size - 1]);
    return size === 1 ? words : words["xyzw"[j & 3]];
  });
}

/** Returns the interpolated radiance of the vertices of a geometry with these `defines`. */
export function radianceOfVertices(model, defines) {
  const predictors = predictorsOf(model, defines);
  const packed = defines.PRT_PACKED_WORDS;
  return varying(
    packed
      ? radianceOfWords(model, () => wordsOfVertex(packed), defines.PRT_CLUSTER_BITS, predictors)
      : radianceOfWeights(model, defines.PRT_WEIGHT_VECTORS, predictors),
    "prtRadiance",
  );
}
