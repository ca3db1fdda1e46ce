// Loads models with transfer of texels.

import { clustersOf } from "./clusteredPca.js";
import { wordsOf } from "./packedWords.js";
import { PrtkitModel } from "./PrtkitModel.js";
import { TABLES } from "./tables.js";
import { RelitMaps } from "./RelitMaps.js";
import { expect, TEXELS, TRANSFER, viewsOf } from "./wholeExtension.js";
import { wordTexture } from "./wordImages.js";

const holds = (value, what) => expect(value, what, TEXELS);

/** Returns the index of the texture coordinates that a primitive names, after checks. */
function coordinatesOf({ geometry }, { texCoord }) {
  holds(Number.isInteger(texCoord) && texCoord >= 0, "texCoord of a primitive is not an integer of at least 0");
  holds(texCoord < 4, `a primitive uses TEXCOORD_${texCoord} for its map; three supports TEXCOORD_0 to TEXCOORD_3`);
  const name = texCoord === 0 ? "uv" : `uv${texCoord}`;
  holds(geometry.hasAttribute(name), `a primitive has no TEXCOORD_${texCoord}, which its map uses`);
  return texCoord;
}

/**
 * Loads transfer of texels; see transferOfVertices. `passOf(model, defines, words)`: creates the pass that
 * draws the maps.
 */
export async function transferOfTexels(set, views, root, parser, passOf) {
  const bytes = await views(viewsOf(set));
  const clusters = clustersOf(set, (i) => bytes.get(i));
  const words = wordsOf(clusters);
  const { length } = set.maps[0].images;
  holds(words === length, `a texel has ${length} words, not ${words}`);
  const maps = [];
  for (const map of set.maps) {
    const textures = await Promise.all(map.images.map((i) => wordTexture(parser, i, map)));
    maps.push({ width: map.width, height: map.height, repeats: map.repeats === true, words: textures });
  }
  const model = new PrtkitModel(clusters, root);
  model.texels = maps.reduce((sum, { width, height }) => sum + width * height, 0);
  model.bytesPerTexel = 4 * words;
  model.maps = new RelitMaps(maps, passOf(model, { ...TABLES, PRT_CLUSTER_BITS: clusters.clusterBits }, words));
  const of = (mesh, primitive) => {
    const placed = primitive?.extensions?.[TRANSFER];
    if (placed?.map === undefined) return null;
    holds(maps[placed.map] !== undefined, "a primitive names a map that does not exist");
    return { uniforms: {}, defines: { PRT_LIGHTMAP: 1 }, lightMap: model.maps.texture(placed.map, coordinatesOf(mesh, placed)) };
  };
  return { model, of };
}
