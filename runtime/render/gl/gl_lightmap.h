#pragma once

// Compressed lightmaps on the GPU: a compute shader lights their texels. An OpenGL 4.5 context must be
// current.

#include "prt/core/cluster_lighting.h"
#include "prt/core/lightmap.h"
#include "runtime/render/gl/gl_objects.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

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

/// A compressed lightmap on the GPU, lit by `shaders/prt_lightmap.comp`.
class GlLightmap {
public:
    /// Uploads the weights of the texels and the clusters. Keeps a reference to `lightmap.layout`, which must
    /// outlive this object. The weights must be packed, and the transfer must have no
    /// predictors. Textures are undefined until `set_light`. Throws
    /// `Error` if the layout of the transfer is invalid, a texel has more words than shaders support, the
    /// device does not support textures of the size of a map, GPU memory runs out, or the driver cannot build
    /// the program.
    explicit GlLightmap(const CompressedLightmap& lightmap);

    /// Computes the radiance of all texels for `lighting`, and all mip levels. Changes the program in use and
    /// the bound storage buffers, textures and image units. Throws the errors of `ClusterLighting::update`.
    void set_light(const Lighting& lighting);
    /// Returns the lit textures. They are valid as long as this object and the lightmap of its constructor.
    GlLightmapTextures textures() const { return {&layout_, maps_}; }
    /// Returns the approximate size of all data on the GPU in bytes: weights, clusters, constants and lit
    /// textures with mip levels.
    std::size_t bytes() const { return bytes_; }

private:
    const LightmapLayout& layout_;
    ClusterLighting relighter_;
    std::vector<glm::vec4> computed_;
    GlObject program_, clusters_, constants_;
    std::vector<std::vector<GlObject>> words_; ///< [maps][words] R32UI
    std::vector<GlObject> maps_;               ///< [maps] RGBA16F
    std::size_t bytes_ = 0;
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
