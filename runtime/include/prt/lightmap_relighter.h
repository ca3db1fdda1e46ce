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

/// Storage format of a texel. No format stores negative values; they become 0.
enum class LightmapFormat {
    rgb9e5,    ///< GL_RGB9_E5, VK_FORMAT_E5B9G9R9_UFLOAT_PACK32: nine bits each, up to 65 408
    r11g11b10, ///< GL_R11F_G11F_B10F, VK_FORMAT_B10G11R11_UFLOAT_PACK32: mantissas of six, six and five bits,
               ///< up to 64 512
    rgba16,    ///< half floats, alpha 1, up to 65 504
};

/// Returns the size of a texel in bytes.
std::size_t bytes_per_texel(LightmapFormat format);

/// Mip level of a texture: half the size of the previous level, rounded down, at least 1.
struct LightmapLevel {
    int width, height;
    std::size_t first; ///< byte offset of the level
};

/// Computes lightmap textures. Thread-safe. Allocates only in the constructor; `update` starts threads unless
/// `threads` is 1.
class LightmapRelighter {
public:
    /// Keeps a reference to `lightmap`, whose weights must be packed.
    LightmapRelighter(const CompressedLightmap& lightmap, LightmapFormat format);

    /// Returns the mip levels of a map, from full size down to one texel.
    std::span<const LightmapLevel> levels(std::size_t map) const { return levels_[map]; }
    /// Returns the size of all levels of a map in bytes.
    std::size_t bytes(std::size_t map) const;

    /// Writes all levels, in order and row by row, to `texels` [bytes(map)]. Each texel of a level is the
    /// mean of two by two texels of the previous one; the last row or column of an odd size is left out.
    /// `constants` are the result of `ClusterLighting::update`.
    void update(std::size_t map, std::span<const glm::vec4> constants, std::span<std::byte> texels,
                int threads = 0) const;

    /// Writes part of the levels, to spread the work: rows [first, last) of the first level and the
    /// corresponding rows of the second. `first` must be even, `last` even or the height. Call
    /// `update_smaller_levels` for the remaining levels when all rows are written.
    void update_rows(std::size_t map, std::span<const glm::vec4> constants, int first, int last,
                     std::span<std::byte> texels) const;
    /// Computes all levels from the third on, after `update_rows` has written all rows of the first two.
    void update_smaller_levels(std::size_t map, std::span<std::byte> texels) const;

private:
    const CompressedLightmap& lightmap_;
    LightmapFormat format_;
    std::vector<ClusterLayout> clusters_;
    std::vector<std::size_t> first_texels_;
    std::vector<std::vector<LightmapLevel>> levels_; ///< [maps]
};

} // namespace prt
