#pragma once

// Compressed lightmaps and volumes on the GPU: a compute shader computes their textures. An OpenGL 4.5
// context must be current for all functions.

#include "prt/core/texture_relighter.h"
#include "runtime/render/gl/gl_objects.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace prt {

/// Lit lightmaps as textures, for `GlScene::light_by`. The view owns nothing.
struct GlLightmapTextures {
    const LightmapLayout* layout = nullptr; ///< null: no lightmaps; vertices are lit
    /// [layout->maps] textures with all mip levels and trilinear filtering. A texel is the exit radiance for
    /// albedo 1, linear Rec. 709, or a color to show.
    std::span<const GlObject> maps;
};

/// Textures of lightmaps or of a volume (prt/core/texture_relighter.h), which the compute shader
/// `shaders/prt_texels.comp` computes. A volume also has the visibility and index textures of shaders that
/// include `shaders/prt_volume.glsl`.
class GlRelitTextures {
public:
    /// Uploads all data that do not depend on the lighting. Keeps a reference to the lightmap or volume,
    /// whose weights must be packed and whose transfer must have no predictors. `format`: format of the
    /// textures, not rgb9e5, which shaders cannot write. The light texture of a volume filters linearly for
    /// rgba16 and does not filter for rgba32. Textures are undefined until `set_light`. Throws `Error` if GPU
    /// memory runs out, if the device does not support textures of this size, if a receiver has more words
    /// than shaders support, or if the driver cannot build the program. Throws the errors of the constructors
    /// of TextureRelighter and VolumeLookup.
    explicit GlRelitTextures(const CompressedLightmap& lightmap, TexelFormat format = TexelFormat::rgba16);
    explicit GlRelitTextures(const CompressedVolume& volume, TexelFormat format = TexelFormat::rgba16);

    /// Computes all textures for `lighting`, and all mip levels. `sun`: see
    /// TextureRelighter::update_constants. Magnitudes above 65 504 become 65 504, in all formats. Changes the
    /// program in use and the bound storage buffers, textures and image units. Throws the errors of
    /// `ClusterLighting::update`.
    void set_light(const Lighting& lighting, const std::optional<glm::vec3>& sun = {});
    /// Returns the textures, [relighter().textures()].
    std::span<const GlObject> textures() const { return textures_; }
    /// Binds the light, visibility and index textures of a volume to the texture units PRT_UNIT_VOLUME_* of
    /// shaders/shared_layout.h for subsequent draws.
    void bind_volume() const;
    /// Returns the object that computes the constants, and that can compute the textures on the CPU. Valid as
    /// long as this object.
    const TextureRelighter& relighter() const { return relighter_; }
    /// Returns level 0 of a texture as floats, [depth][height][width]. Waits for the GPU. Throws `Error` if
    /// OpenGL reports an error.
    std::vector<glm::vec4> read(std::size_t texture) const;
    /// Returns the approximate size of all data on the GPU in bytes: weights, clusters, constants, indices of
    /// the probes of each brick, and textures with mip levels.
    std::size_t bytes() const { return bytes_; }

private:
    GlRelitTextures(const ClusteredTransfer& transfer, const TextureRelighter& relighter);

    TextureRelighter relighter_;
    std::vector<glm::vec4> computed_;
    GlObject program_, clusters_, constants_;
    std::vector<std::vector<GlObject>> words_; ///< maps: [maps][words] R32UI; volume: [1][1] buffer
    std::vector<GlObject> textures_;
    GlObject probes_, visibility_, index_; ///< volume
    std::size_t bytes_;
};

/// Creates one texture per map of `layout`, RGB16F with all mip levels, from `radiance` [layout.texels()]:
/// exit radiance for albedo 1, or a color. Throws `Error` if GPU memory runs out, or if the device does not
/// support textures of the size of a map.
std::vector<GlObject> make_lightmap_textures(const LightmapLayout& layout,
                                             std::span<const glm::vec3> radiance);
/// Creates one texture per map of `layout`, RGBA16F, whose contents are undefined. Mip levels are allocated.
/// A shader must write level 0, and the caller must generate the other levels. Throws the errors of the other
/// overload.
std::vector<GlObject> make_lightmap_textures(const LightmapLayout& layout);

} // namespace prt
