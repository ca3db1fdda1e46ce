#pragma once

// Compressed lightmaps in glTF files, and the words of their texels that a game binds as textures.
// Experimental.

#include "prt/gltf/transfer_gltf.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Writes `lightmap` as PRTKIT_lightmap into `document`, from which `scene` was extracted, and replaces
/// existing transfer of surfaces. Meshes that several nodes share are copied per node, and primitives without
/// normals get flat normals. Throws `Error` if the weights are not packed, if the copies need too much memory
/// for the size of the file, or if `document` is damaged.
void write_lightmap(GltfDocument& document, const Scene& scene, const CompressedLightmap& lightmap);

/// Returns the compressed lightmap in `document`, from which `scene` was extracted. Returns no value if the
/// file has no lightmap, or one with raw (uncompressed) transfer. Throws `Error` if the lightmap is damaged,
/// has an unsupported version, or needs too much memory for the size of the file.
std::optional<CompressedLightmap> read_compressed_lightmap(const GltfDocument& document, const Scene& scene);

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
