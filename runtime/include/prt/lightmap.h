#pragma once

// Transfer of texels: lightmaps that are relit. Experimental.

#include "prt/adjacency.h"
#include "prt/baked_transfer.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// A map of texels over some surfaces, row by row from v = 0 on.
struct LightmapSize {
    int width = 0, height = 0;
    bool repeats = false; ///< some triangles lie in other squares than 0..1, where the map goes on

    std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    friend bool operator==(const LightmapSize&, const LightmapSize&) = default;
};

/// Where a primitive has its texels.
struct LightmapPlace {
    std::size_t map = 0;
    int texcoord = 1; ///< TEXCOORD_n

    friend bool operator==(const LightmapPlace&, const LightmapPlace&) = default;
};

/// Texels are numbered map behind map.
struct LightmapLayout {
    std::vector<LightmapSize> maps;
    std::vector<LightmapPlace> places; ///< [primitives of the scene]

    std::size_t texels() const;
    /// Number of the first texel of each map, and of all texels: [maps + 1].
    std::vector<std::size_t> first_texels() const;
    friend bool operator==(const LightmapLayout&, const LightmapLayout&) = default;
};

/// As a bake makes it. Receivers are the texels that charts touch, and those beside them that filters read.
struct BakedLightmap {
    LightmapLayout layout;
    std::vector<std::uint32_t> texels; ///< [receivers] ascending
    /// [receivers] m², what bilinear filters read of it where the charts are: all together the surface.
    std::vector<float> areas;
    /// Receivers that show one place of the surface on both sides of a cut, in ascending order, each once.
    std::vector<Edge> seams;
    BakedTransfer baked;
};

/// As a game loads it: receivers are all texels.
struct CompressedLightmap {
    LightmapLayout layout;
    CompressedTransfer compressed;
};

/// A place where a surface is cut: what bilinear filters read on the two sides of it, less each other, so
/// that the sum of weights and values is how far light jumps there.
struct SeamJump {
    std::array<std::uint32_t, 8> receivers;
    std::array<float, 8> weights;
};

/// Receivers whose light has to go together: texels side by side, and the two sides of seams.
std::vector<Edge> lightmap_edges(const LightmapLayout& layout, std::span<const std::uint32_t> texels,
                                 std::span<const Edge> seams);

/// For every texel of a map the place in `texels`, which are those of the map, counted from its first, of one
/// that lies near it: its own where it is among them. [size.texels()]; 0 where there are none.
std::vector<std::uint32_t> nearest_receivers(const LightmapSize& size, std::span<const std::uint32_t> texels);

/// What a bilinear filter reads, in texels from the corner of a map.
struct BilinearTexels {
    std::uint32_t texels[4]; ///< of the map
    double weights[4];
};
BilinearTexels bilinear_texels(const LightmapSize& size, double x, double y);

} // namespace prt
