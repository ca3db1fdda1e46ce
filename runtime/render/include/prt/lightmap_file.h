#pragma once

// Compressed lightmaps in glTF files, and what a game binds of them. Experimental.

#include "prt/lightmap_gltf.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Writes PRTKIT_lightmap into `document`, from which `scene` was extracted; weights have to be packed.
/// Throws `Error`.
void write_lightmap(GltfDocument& document, const Scene& scene, const CompressedLightmap& lightmap);

/// The compressed lightmap in the file; nothing when it holds none. Throws `Error` when it is damaged.
std::optional<CompressedLightmap> read_compressed_lightmap(const GltfDocument& document, const Scene& scene);

/// `compressed` receivers of `baked` as a game loads them: all texels, those that are no receivers as one
/// near them.
CompressedLightmap spread_over_maps(const BakedLightmap& baked, ClusteredTransfer compressed);

/// `values` [texels] of some texels as those of all, others as one near them.
std::vector<glm::vec3> spread_over_maps(const LightmapLayout& layout, std::span<const std::uint32_t> texels,
                                        std::span<const glm::vec3> values);

/// The receivers `texels` of all texels of a lightmap, in their order.
ClusteredTransfer picked_texels(const ClusteredTransfer& all, std::span<const std::uint32_t> texels);

/// Word `word` of every texel of map `map`, row by row: the texels of an R32UI texture.
std::vector<std::uint32_t> words_of_map(const CompressedLightmap& lightmap, std::size_t map, int word);

} // namespace prt
