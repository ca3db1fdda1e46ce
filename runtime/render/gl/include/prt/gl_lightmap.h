#pragma once

// Compressed lightmaps on the GPU.

#include "prt/cluster_lighting.h"
#include "prt/gl_objects.h"
#include "prt/lightmap.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <span>
#include <vector>

namespace prt {

/// Lit lightmaps as textures for surfaces, for `GlScene::light_by`.
struct GlLightmapTextures {
    const LightmapLayout* layout = nullptr;
    std::span<const GlObject> maps; ///< [layout->maps] with all levels, filtered
};

/// A compressed lightmap on the GPU, lit by `shaders/prt_lightmap.comp`.
class GlLightmap {
public:
    /// Uploads words and clusters. Keeps a reference to the layout of `lightmap`. Throws `Error` if memory
    /// runs out, or if a texel has more words than shaders support.
    explicit GlLightmap(const CompressedLightmap& lightmap);

    /// Computes the constants for `lighting`, then the radiance of all texels and the smaller mip levels.
    void set_light(const Lighting& lighting);
    /// Returns the lit textures; they are valid as long as this object.
    GlLightmapTextures textures() const { return {&layout_, maps_}; }
    /// Size on the GPU in bytes.
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

/// Creates one texture per map from `radiance` [layout.texels()], with all mip levels.
std::vector<GlObject> make_lightmap_textures(const LightmapLayout& layout,
                                             std::span<const glm::vec3> radiance);
/// Creates one texture per map without content, RGBA16F, for shaders that write them.
std::vector<GlObject> make_lightmap_textures(const LightmapLayout& layout);

} // namespace prt
