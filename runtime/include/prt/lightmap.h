#pragma once

// Transfer of texels, for lightmaps that can be relit. Experimental.

#include "prt/adjacency.h"
#include "prt/baked_transfer.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Size of a lightmap; texels are stored row by row from v = 0.
struct LightmapSize {
    int width = 0, height = 0;
    bool repeats = false; ///< some triangles use UVs outside 0..1, where the map repeats

    std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    friend bool operator==(const LightmapSize&, const LightmapSize&) = default;
};

/// Lightmap and UV set of a primitive.
struct LightmapPlacement {
    std::size_t map = 0;
    int texcoord = 1; ///< TEXCOORD_n

    friend bool operator==(const LightmapPlacement&, const LightmapPlacement&) = default;
};

/// Layout of all lightmaps; texels are numbered map by map.
struct LightmapLayout {
    std::vector<LightmapSize> maps;
    std::vector<LightmapPlacement> placements; ///< [primitives of the scene] map and UV set of each

    std::size_t texels() const;
    /// Returns the number of the first texel of each map, and the total number of texels: [maps + 1].
    std::vector<std::size_t> first_texels() const;
    friend bool operator==(const LightmapLayout&, const LightmapLayout&) = default;
};

/// Lightmaps as a bake produces them. Receivers are the texels that charts touch, and the adjacent texels
/// that bilinear filters read.
struct BakedLightmap {
    LightmapLayout layout;
    std::vector<std::uint32_t> texels; ///< [receivers] in ascending order
    /// [receivers] m²: surface area weighted by the bilinear filters that read the texel; the sum is the
    /// surface area.
    std::vector<float> areas;
    /// Pairs of receivers that show the same surface point on both sides of a UV seam, in ascending order,
    /// without duplicates.
    std::vector<Edge> seams;
    BakedTransfer baked;
};

/// Lightmaps as a game loads them. Receivers are all texels.
struct CompressedLightmap {
    LightmapLayout layout;
    CompressedTransfer compressed;
};

/// Point on a UV seam. The weighted sum of receiver values is the bilinear sample on one side minus the
/// sample on the other: the jump of light at this point.
struct SeamJump {
    std::array<std::uint32_t, 8> receivers;
    std::array<float, 8> weights;
};

/// Returns the pairs of receivers whose light must match: adjacent ones among `texels` [receivers], and the
/// pairs of `seams`.
std::vector<Edge> lightmap_edges(const LightmapLayout& layout, std::span<const std::uint32_t> texels,
                                 std::span<const Edge> seams);

/// Returns for each texel of a map the index of a nearby entry of `texels`, [size.texels()]. Entries are
/// texel numbers within the map. A texel that is in `texels` gets its own index. Returns 0 everywhere if
/// `texels` is empty.
std::vector<std::uint32_t> nearest_receivers(const LightmapSize& size, std::span<const std::uint32_t> texels);

/// The four texels of a bilinear sample, with weights.
struct BilinearTexels {
    std::uint32_t texels[4]; ///< number within the map
    double weights[4];
};
/// Returns the texels of the bilinear sample at (x, y), in texels from the corner of the map; texel i has its
/// center at i + 0.5. Positions outside the map repeat if `size.repeats`, otherwise they are clamped.
BilinearTexels bilinear_texels(const LightmapSize& size, double x, double y);

} // namespace prt
