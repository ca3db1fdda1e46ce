#pragma once

// Transfer of texels, for lightmaps that can be relit. A scene has one or several maps; "texel number" counts
// the texels of all maps, map by map, "number within the map" those of one map. Both count row by row from v
// = 0, and from u = 0 in each row. Experimental.

#include "prt/core/adjacency.h"
#include "prt/core/baked_transfer.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

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

/// Lightmap and UV set of one primitive.
struct LightmapPlacement {
    std::size_t map = 0; ///< index in `LightmapLayout::maps`
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

/// Storage format of a texel. Negative radiance and NaN are stored as 0, radiance above the maximum of the
/// format as that maximum.
enum class LightmapFormat {
    rgb9e5,    ///< 4 bytes: three mantissas of nine bits with one exponent, maximum 65 408. GL_RGB9_E5,
               ///< VK_FORMAT_E5B9G9R9_UFLOAT_PACK32
    r11g11b10, ///< 4 bytes: floats with mantissas of six (red), six (green) and five (blue) bits, maximum
               ///< 65 024 (red, green) and 64 512 (blue). GL_R11F_G11F_B10F,
               ///< VK_FORMAT_B10G11R11_UFLOAT_PACK32
    rgba16,    ///< 8 bytes: four half floats, alpha 1, maximum 65 504. GL_RGBA16F,
               ///< VK_FORMAT_R16G16B16A16_SFLOAT
};

/// Returns the size of a texel of `format` in bytes, 4 or 8.
std::size_t bytes_per_texel(LightmapFormat format);

/// Mip level of a map. Level 0 has the size of the map. Each following level has half the width and height of
/// the level before, rounded down, at least 1.
struct LightmapLevel {
    int width, height; ///< in texels
    std::size_t first; ///< byte offset of the level in the buffer of its map
};

/// Computes the textures of lightmaps with all mip levels. Concurrent calls of const functions are safe if
/// they write to different memory. Only the constructor allocates; `update` also allocates to start threads,
/// unless `threads` is 1.
class LightmapRelighter {
public:
    /// Keeps a reference to `lightmap`, which must outlive the relighter and must have packed weights.
    LightmapRelighter(const CompressedLightmap& lightmap, LightmapFormat format);

    /// Returns the mip levels of map number `map`, from full size to 1 x 1.
    std::span<const LightmapLevel> levels(std::size_t map) const { return levels_[map]; }
    /// Returns the size of the buffer of map number `map`, all mip levels together, in bytes.
    std::size_t bytes(std::size_t map) const;

    /// Writes the exit radiance for albedo 1 of map number `map` to `texels` [bytes(map)]: all mip levels,
    /// each at its offset `LightmapLevel::first`, row by row from v = 0. A texel of a level is the mean of 2
    /// x 2 texels of the level before, or of 2 texels if that level has the width or height 1; the last row
    /// or column of an odd size above 1 is ignored. `constants` is the result of `ClusterLighting::update`
    /// for the transfer of the lightmap. Uses `threads` threads; 0: all hardware threads.
    void update(std::size_t map, std::span<const glm::vec4> constants, std::span<std::byte> texels,
                int threads = 0) const;

    /// Writes a part of the result of `update`, to spread the work over frames or threads: rows [first, last)
    /// of level 0 of map number `map`, and the rows of level 1 that are means of these. `first` must be even;
    /// `last` must be even or the height of the map. `constants` and `texels` are those of `update`. After
    /// all rows, call `update_smaller_levels`.
    void update_rows(std::size_t map, std::span<const glm::vec4> constants, int first, int last,
                     std::span<std::byte> texels) const;
    /// Writes levels 2 and higher of map number `map` to `texels` [bytes(map)], in which `update_rows` must
    /// have written all rows of levels 0 and 1.
    void update_smaller_levels(std::size_t map, std::span<std::byte> texels) const;

private:
    const CompressedLightmap& lightmap_;
    LightmapFormat format_;
    std::vector<ClusterLayout> clusters_;            ///< [clusters]
    std::vector<std::size_t> first_texels_;          ///< [maps + 1] `LightmapLayout::first_texels`
    std::vector<std::vector<LightmapLevel>> levels_; ///< [maps][mip levels]
};

} // namespace prt
