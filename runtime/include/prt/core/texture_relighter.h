#pragma once

// The work of a game with lightmaps or a volume when the lighting changes: computes the texels of the maps,
// or of the light texture of the volume.
//
//     TextureRelighter relighter(lightmap, TexelFormat::rgb9e5);       // once per model; or of a volume
//     std::vector<glm::vec4> constants(relighter.rows());
//     std::vector<std::byte> texels(relighter.bytes(0));
//     relighter.update_constants(light, towards_sun, constants);       // when the lighting changes
//     relighter.update(0, constants, texels);                          // then upload
//
// Experimental.

#include "prt/core/cluster_lighting.h"
#include "prt/core/lightmap.h"
#include "prt/core/transfer_volume.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Storage format of a texel. Maps support all formats: negative radiance and NaN are stored as 0, radiance
/// above the maximum of the format as that maximum. Volumes, whose numbers have signs, support the last two.
enum class TexelFormat {
    rgb9e5,    ///< 4 bytes: three mantissas of nine bits with one exponent, maximum 65 408. GL_RGB9_E5,
               ///< VK_FORMAT_E5B9G9R9_UFLOAT_PACK32
    r11g11b10, ///< 4 bytes: floats with mantissas of six (red), six (green) and five (blue) bits, maximum
               ///< 65 024 (red, green) and 64 512 (blue). GL_R11F_G11F_B10F,
               ///< VK_FORMAT_B10G11R11_UFLOAT_PACK32
    rgba16,    ///< 8 bytes: four half floats, maximum 65 504 (volumes: magnitude). GL_RGBA16F,
               ///< VK_FORMAT_R16G16B16A16_SFLOAT
    rgba32,    ///< 16 bytes: four floats; some GPUs cannot filter such textures. GL_RGBA32F,
               ///< VK_FORMAT_R32G32B32A32_SFLOAT
};

/// Returns the size of a texel of `format` in bytes, 4 to 16.
std::size_t bytes_per_texel(TexelFormat format);

/// Mip level of a texture.
struct TextureLevel {
    glm::ivec3 size{0};    ///< width, height and depth in texels; the depth of a map is 1
    std::size_t first = 0; ///< byte offset of the level in the buffer of its texture

    /// Returns the index of a texel in the level.
    std::size_t texel(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x);
    }
};

/// Computes the textures of lightmaps with all mip levels, or the light texture of a volume. Immutable.
/// Concurrent calls are safe if they write to different memory. Only the constructors allocate; `update` also
/// allocates to start threads, unless `threads` is 1.
class TextureRelighter {
public:
    /// Prepares one texture per map. Keeps a reference to `lightmap`, which must outlive the relighter and
    /// must have packed weights. Throws `Error` if the layout of the transfer is invalid.
    explicit TextureRelighter(const CompressedLightmap& lightmap, TexelFormat format = TexelFormat::rgba16);
    /// Prepares one texture, with the layout of `VolumeAtlas`. Keeps a reference to `volume`, which must
    /// outlive the relighter. Requires a grid that `check_grid` accepts, and packed weights. Throws `Error`
    /// if bricks overlap, if the layout of the transfer is invalid, and if `format` has no signs.
    explicit TextureRelighter(const CompressedVolume& volume, TexelFormat format = TexelFormat::rgba16);

    /// Returns the layout of the transfer vectors, reduced to one output (`TransferLayout::of_one_output`).
    const TransferLayout& layout() const { return lighting_.layout(); }
    /// Returns the number of constants, `ClusterLighting::rows()`.
    std::size_t rows() const { return lighting_.rows(); }
    /// Returns the storage format of all textures.
    TexelFormat format() const { return format_; }
    /// Returns the positions of the bricks of a volume in its light texture; order 0 for maps.
    const VolumeAtlas& atlas() const { return atlas_; }
    /// Returns the number of textures: maps, or 1 for a volume.
    std::size_t textures() const { return textures_.size(); }
    /// Returns the mip levels of a texture. Level 0 has the size of the map; each following level has half
    /// the width and height of the level before, rounded down, at least 1. A volume has only level 0.
    std::span<const TextureLevel> levels(std::size_t texture) const { return textures_[texture].levels; }
    /// Returns the size of the buffer of a texture, all mip levels together, in bytes.
    std::size_t bytes(std::size_t texture) const { return textures_[texture].bytes; }
    /// Returns the number of units that `update_range` counts: rows of a map, or probes of a volume.
    std::size_t units(std::size_t texture) const { return textures_[texture].units; }

    /// Computes the constants for `lighting` and writes them to `constants` [rows() or more]: r, g, b are
    /// those of `ClusterLighting::update`. `sun`: unit direction towards a sun, whose visibility `update`
    /// computes at each probe. The w of output 0 are then the responses of the rows to this sun; all other w
    /// are 0. All w are 0 for maps, if `sun` has no value, and if the transfer has no `direct` term, because
    /// suns then light all of its terms. Throws the errors of `ClusterLighting::update`.
    void update_constants(const LightingView& lighting, const std::optional<glm::vec3>& sun,
                          std::span<glm::vec4> constants) const;

    /// Writes a texture to `texels` [bytes(texture)] from the `constants` [rows()] of `update_constants`.
    /// Uses `threads` threads; 0: all hardware threads. Map: exit radiance for albedo 1, and alpha 1, of all
    /// mip levels, each at its offset `TextureLevel::first`, row by row from v = 0. A texel of a level is the
    /// mean of 2 x 2 texels of the level before, or of 2 texels if that level has the width or height 1; the
    /// last row or column of an odd size above 1 is ignored. Volume: for each probe the coefficients of
    /// incident light, then the visibility of the sun, 0..1, then zeros up to the end of the last plane.
    /// Texels that belong to no brick are not changed.
    void update(std::size_t texture, std::span<const glm::vec4> constants, std::span<std::byte> texels,
                int threads = 0) const;
    /// Writes a part of the result of `update` in the calling thread, to spread the work over frames or
    /// threads, and changes no other texels: units [first, last) of level 0, and the rows of level 1 that are
    /// means of these. For a map, `first` must be even, and `last` must be even or the height. After all
    /// units of a map, call `update_smaller_levels`.
    void update_range(std::size_t texture, std::span<const glm::vec4> constants, std::size_t first,
                      std::size_t last, std::span<std::byte> texels) const;
    /// Writes levels 2 and higher to `texels` [bytes(texture)], in which `update_range` must have written all
    /// units. Does nothing for a volume.
    void update_smaller_levels(std::size_t texture, std::span<std::byte> texels) const;

private:
    struct Texture {
        std::size_t first_receiver, units, bytes;
        std::vector<TextureLevel> levels;
    };
    TextureRelighter(const ClusteredTransfer& transfer, TexelFormat format);
    void update_rows(const Texture& map, const glm::vec4* constants, int first, int last,
                     std::byte* texels) const;

    const ClusteredReceivers& receivers_;
    TexelFormat format_;
    std::size_t outputs_; ///< 1: maps; else coefficients of a probe
    ClusterLighting lighting_;
    std::vector<ClusterLayout> clusters_;
    std::vector<Texture> textures_;
    VolumeAtlas atlas_;
    /// Volume: [rows / outputs][layout().order²] `direct` coefficients of output 0, grey; empty without a
    /// `direct` term
    std::vector<float> direct_;
    std::vector<std::uint32_t> first_texels_; ///< Volume: [probes + 1] first entry of each probe in `texels_`
    std::vector<std::uint32_t> texels_;       ///< Volume: indices of the texels of each probe in a plane
};

} // namespace prt
