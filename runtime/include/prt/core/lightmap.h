#pragma once

// Transfer of texels, for lightmaps that can be relit. A scene has one or several maps; "texel number" counts
// the texels of all maps, map by map, "number within the map" those of one map. Both count row by row from v
// = 0, and from u = 0 in each row. Experimental.

#include "prt/core/adjacency.h"
#include "prt/core/baked_transfer.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Size of one lightmap.
struct LightmapSize {
    int width = 0,        ///< number of texels along u
        height = 0;       ///< number of texels along v
    bool repeats = false; ///< true: some triangles have UVs outside 0..1, where the map repeats; false: the
                          ///< map is clamped

    /// Returns the number of texels of the map.
    std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    friend bool operator==(const LightmapSize&, const LightmapSize&) = default;
};

/// LightmapPlacement::map of a primitive without texels, which has lobes instead.
inline constexpr std::size_t kNoMap = static_cast<std::size_t>(-1);

/// Lightmap and UV set of one primitive.
struct LightmapPlacement {
    std::size_t map = 0; ///< index in `LightmapLayout::maps`, or kNoMap
    int texcoord = 1;    ///< n of the vertex attribute TEXCOORD_n that contains the UVs

    friend bool operator==(const LightmapPlacement&, const LightmapPlacement&) = default;
};

/// Layout of all lightmaps of a scene.
struct LightmapLayout {
    std::vector<LightmapSize> maps;            ///< size of each map
    std::vector<LightmapPlacement> placements; ///< [Scene::primitives] map and UV set of each primitive

    /// Returns the number of texels of all maps together.
    std::size_t texels() const;
    /// Returns the texel number of the first texel of each map, [maps + 1]; the last entry is the number of
    /// texels of all maps.
    std::vector<std::size_t> first_texels() const;
    friend bool operator==(const LightmapLayout&, const LightmapLayout&) = default;
};

/// Lightmaps as a bake produces them. A receiver is a texel that a chart touches, or one of its eight
/// neighbours, which bilinear filters read.
struct BakedLightmap {
    LightmapLayout layout;             ///< sizes of the maps, and map of each primitive
    std::vector<std::uint32_t> texels; ///< [receivers] texel number of each receiver, in ascending order
    /// [receivers] surface area in m² that the texel represents. Each piece of the surface is divided among
    /// the four texels of its bilinear sample by their weights; the sum is the area of the surface. An area
    /// can be 0.
    std::vector<float> areas;
    /// Pairs of receivers that show the same surface point on both sides of a UV seam, in ascending order,
    /// without duplicates.
    std::vector<Edge> seams;
    BakedTransfer baked; ///< transfer vectors of the receivers, in the order of `texels`
};

/// Lightmaps as a game loads them. Every texel is a receiver.
struct CompressedLightmap {
    LightmapLayout layout;         ///< sizes of the maps, and map of each primitive
    CompressedTransfer compressed; ///< receivers in the order of texel numbers: [layout.texels()]
};

/// Point on a UV seam, with the texels of its bilinear samples on both sides. The sum of weights[i] times the
/// value of receivers[i] is the sample on the first side minus the sample on the second: the jump of light.
struct SeamJump {
    /// Indices of receivers: the four texels of the sample on the first side, then those of the second side.
    std::array<std::uint32_t, 8> receivers;
    /// Bilinear weight of each entry of `receivers`; negative or 0 on the second side. The sum is 0.
    std::array<float, 8> weights;
};

/// Returns the pairs of receivers whose light must match, in ascending order, without duplicates: receivers
/// of horizontally or vertically adjacent texels of a map, also across its edges if the map repeats, and the
/// pairs of `seams`. `texels` [receivers] contains texel numbers in ascending order, `seams` indices of
/// receivers.
std::vector<Edge> lightmap_edges(const LightmapLayout& layout, std::span<const std::uint32_t> texels,
                                 std::span<const Edge> seams);

/// Returns for each texel of one map the index i of the nearest entry texels[i], [size.texels()]. The
/// distance is the number of horizontal and vertical steps between texels, across the edges of the map if
/// `size.repeats`. `texels` contains numbers within the map, without duplicates. Returns all zeros if
/// `texels` is empty.
std::vector<std::uint32_t> nearest_receivers(const LightmapSize& size, std::span<const std::uint32_t> texels);

/// The four texels of a bilinear sample. The sample is the sum of the weights times the values of the texels.
struct BilinearTexels {
    std::uint32_t texels[4]; ///< numbers within the map; at the edge of a map a texel can occur repeatedly
    double weights[4];       ///< weight of each texel, 0..1; the sum is 1
};
/// Returns the texels of the bilinear sample at (x, y), with x the coordinate u times the width and y the
/// coordinate v times the height of the map. Column or row i has its center at i + 0.5. Outside the map, the
/// map repeats if `size.repeats`, else the position is clamped. A coordinate that is not finite counts as 0.
BilinearTexels bilinear_texels(const LightmapSize& size, double x, double y);

} // namespace prt
