#pragma once

// Compressed lightmaps in glTF files, and the data that a game binds. Experimental.

#include "prt/lightmap_gltf.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Writes PRTKIT_lightmap into `document`, from which `scene` was extracted. Throws `Error` unless the
/// weights are packed.
void write_lightmap(GltfDocument& document, const Scene& scene, const CompressedLightmap& lightmap);

/// Returns the compressed lightmap in the file; empty if absent. Throws `Error` if it is damaged.
std::optional<CompressedLightmap> read_compressed_lightmap(const GltfDocument& document, const Scene& scene);

/// Expands the `compressed` receivers of `baked` to all texels, as a game loads them. Every other texel gets
/// the values of a nearby receiver.
CompressedLightmap scatter_to_maps(const BakedLightmap& baked, ClusteredTransfer compressed);

/// Expands `values` [texels.size()], which belong to `texels`, to all texels, [layout.texels()]. Every other
/// texel gets the value of a nearby one.
std::vector<glm::vec3> scatter_to_maps(const LightmapLayout& layout, std::span<const std::uint32_t> texels,
                                       std::span<const glm::vec3> values);

/// Returns the receivers `texels` of a lightmap whose receivers are all texels, in the order of `texels`.
ClusteredTransfer gather_texels(const ClusteredTransfer& all, std::span<const std::uint32_t> texels);

/// Returns word `word` of every texel of map `map`, row by row: the texels of an R32UI texture.
std::vector<std::uint32_t> words_of_map(const CompressedLightmap& lightmap, std::size_t map, int word);

} // namespace prt
