#pragma once

// Images with the words of compressed lightmaps, which a file contains and a game binds as textures.
// Experimental.

#include "prt/load/model.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Returns `lightmap` with its words encoded as PNG images, for `write_encoded_lightmap` of
/// prt/gltf/transfer_gltf.h. Throws `Error` if the weights are not packed.
EncodedLightmap encoded_lightmap(const CompressedLightmap& lightmap);

/// Returns the lightmap of a file with its words decoded. `encoded`: Model::lightmap, or the result of
/// `read_encoded_lightmap` of prt/gltf/transfer_gltf.h. Throws `Error` if an image is damaged, or does not
/// have the size of its map.
CompressedLightmap decoded_lightmap(EncodedLightmap encoded);

/// Returns a lightmap whose receivers are all texels of the maps, as a game loads them. `compressed`: the
/// compressed transfer of `baked`, with the same receivers; it must have no predictors, because texels do not
/// support them. Texel baked.texels[i] gets the cluster index and the weights of receiver i; every other
/// texel gets those of the nearest receiver of the same map (`nearest_receivers`). In a map without
/// receivers, the cluster index and all bytes of the weights are 0.
CompressedLightmap scatter_to_maps(const BakedLightmap& baked, ClusteredTransfer compressed);

/// Returns a value for every texel of the maps, [layout.texels()]. Texel texels[i] gets values[i]; every
/// other texel gets the value of the nearest texel of the same map that has one. In a map without values all
/// are 0. `texels`: numbers of texels in ascending order, as in BakedLightmap; `values`: [texels.size()].
std::vector<glm::vec3> scatter_to_maps(const LightmapLayout& layout, std::span<const std::uint32_t> texels,
                                       std::span<const glm::vec3> values);

/// Returns transfer that contains only some receivers of `all`: receiver i is receiver texels[i] of `all`.
/// The receivers of `all` are all texels of a lightmap, numbered as in LightmapLayout. The result has a copy
/// of the bases, but no predictor coordinates (ClusteredReceivers::predictors).
ClusteredTransfer gather_texels(const ClusteredTransfer& all, std::span<const std::uint32_t> texels);

/// Returns one 32-bit word of packed weights of every texel of a map, row by row from v = 0: the contents of
/// an R32UI texture. `map`: index into LightmapLayout::maps. `word`: 0 to ClusteredReceivers::words - 1.
std::vector<std::uint32_t> words_of_map(const CompressedLightmap& lightmap, std::size_t map, int word);

} // namespace prt
