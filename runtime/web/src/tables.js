// Tables of the shader: textures of vectors of four, row by row.

import { DataTexture, FloatType, NearestFilter, RGBAFormat, RGBAIntegerFormat, UnsignedIntType } from "three";
import { clusterTable } from "./clusteredPca.js";

const WIDTH = 256;

/** Returns the shader defines of tables with `width` texels per row. */
export const tablesOf = (width) => ({ PRT_CONSTANTS_TEXTURE: 1, PRT_TEXTURE_WIDTH: width });
/** Returns the defines of a model's tables. */
export const TABLES = tablesOf(WIDTH);

/** Returns the width of an approximately square table for `count` vectors. */
export const widthFor = (count) => Math.max(WIDTH, 2 ** Math.ceil(Math.log2(Math.max(1, count)) / 2));

function tableTexture(count, data, format, type, width) {
  const height = Math.max(1, Math.ceil(count / width));
  const padded = new data.constructor(4 * width * height);
  padded.set(data);
  const texture = new DataTexture(padded, width, height, format, type);
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** Returns a table of `count` constants, which are zero. */
export const constantsTextureOf = (count, width = WIDTH) => tableTexture(count, new Float32Array(0), RGBAFormat, FloatType, width);

/** Returns the table of clusters. */
export const clustersTextureOf = (clusters, width = WIDTH) =>
  tableTexture(clusters.components.length, clusterTable(clusters), RGBAIntegerFormat, UnsignedIntType, width);
