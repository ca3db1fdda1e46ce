#pragma once

// The per-lighting work of a game with lightmaps: radiance of all texels, as a texture takes it.
//
//     LightmapFormer former(lightmap, LightmapFormat::rgb9e5);         // once per model
//     std::vector<std::byte> texels(former.bytes(map));
//     constants.form(light, formed);                                   // prt/constant_former.h
//     former.form(map, formed, texels);                                // when the lighting changes: then
//     upload
//
// The texture goes into the lightmap slot of an engine: exit radiance is what it holds, times albedo; slots
// that want irradiance take pi times as much. Experimental.

#include "prt/lightmap.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// How a texel is stored. None holds what is below zero, which becomes 0.
enum class LightmapFormat {
    rgb9e5,    ///< GL_RGB9_E5, VK_FORMAT_E5B9G9R9_UFLOAT_PACK32: nine bits each, up to 65 408
    r11g11b10, ///< GL_R11F_G11F_B10F, VK_FORMAT_B10G11R11_UFLOAT_PACK32: six, six and five, up to 64 512
    rgba16,    ///< half floats, alpha 1, up to 65 504
};

std::size_t bytes_per_texel(LightmapFormat format);

/// A level of a texture, halved from that before and rounded down, 1 at least.
struct LightmapLevel {
    int width, height;
    std::size_t first; ///< byte behind the levels before it
};

/// Thread-safe. Allocates when it is made alone; `form` starts threads where it may have more than one.
class LightmapFormer {
public:
    /// Keeps a reference to `lightmap`, whose weights are packed.
    LightmapFormer(const CompressedLightmap& lightmap, LightmapFormat format);

    /// From the map down to one texel.
    std::span<const LightmapLevel> levels(std::size_t map) const { return levels_[map]; }
    /// Of all levels of a map.
    std::size_t bytes(std::size_t map) const;

    /// Writes all levels, level behind level and row by row, to `texels` [bytes(map)]. Each is the mean over
    /// two by two texels of the one before, of which odd sides leave the last out. `constants` as
    /// `ConstantFormer` forms them.
    void form(std::size_t map, std::span<const glm::vec4> constants, std::span<std::byte> texels,
              int threads = 0) const;

    /// The same in pieces, to spread the work: rows [first, last) of the first level, `first` even, `last`
    /// even or the height, and of the one that is half of it; then, when all of those are there, the others.
    void form_rows(std::size_t map, std::span<const glm::vec4> constants, int first, int last,
                   std::span<std::byte> texels) const;
    void form_smaller_levels(std::size_t map, std::span<std::byte> texels) const;

private:
    const CompressedLightmap& lightmap_;
    LightmapFormat format_;
    std::vector<ClusterLayout> clusters_;
    std::vector<std::size_t> first_texels_;
    std::vector<std::vector<LightmapLevel>> levels_; ///< [maps]
};

} // namespace prt
