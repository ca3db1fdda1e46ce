#pragma once

// The per-lighting work of a game with lightmaps: computes the radiance of all texels in a texture format.
//
//     LightmapRelighter relighter(lightmap, LightmapFormat::rgb9e5);    // once per model
//     std::vector<std::byte> texels(relighter.bytes(map));
//     clusters.update(light, constants);        // ClusterLighting of prt/cluster_lighting.h
//     relighter.update(map, constants, texels); // when the lighting changes; then upload
//
// Bind the texture to the lightmap slot of an engine. It contains exit radiance for albedo 1; the shader
// multiplies it by the albedo. Slots that expect irradiance need pi times the value. Experimental.

#include "prt/lightmap.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace prt {

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
