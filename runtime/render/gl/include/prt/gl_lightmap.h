#pragma once

#include "prt/constant_former.h"
#include "prt/gl_objects.h"
#include "prt/lightmap.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <span>
#include <vector>

namespace prt {

/// Lit lightmaps as surfaces look them up: what `GlScene::light_by` takes.
struct GlLightmapTextures {
    const LightmapLayout* layout = nullptr;
    std::span<const GlObject> maps; ///< [layout->maps] with all levels, filtered
};

/// A compressed lightmap on the GPU, lit by `shaders/prt_lightmap.comp`.
class GlLightmap {
public:
    /// Uploads words and clusters. Keeps a reference to the layout of `lightmap`. Throws `Error` when memory
    /// runs out, and where a texel has more words than shaders take.
    explicit GlLightmap(const CompressedLightmap& lightmap);

    /// Forms the constants for `lighting`, then radiance of all texels and their smaller levels.
    void set_light(const Lighting& lighting);
    GlLightmapTextures textures() const { return {&layout_, maps_}; }
    /// Bytes that it takes on the GPU.
    std::size_t bytes() const { return bytes_; }

private:
    const LightmapLayout& layout_;
    ConstantFormer former_;
    std::vector<glm::vec4> formed_;
    GlObject program_, clusters_, constants_;
    std::vector<std::vector<GlObject>> words_; ///< [maps][words] R32UI
    std::vector<GlObject> maps_;               ///< [maps] RGBA16F
    std::size_t bytes_ = 0;
};

/// Textures of `radiance` [layout.texels()], with all levels.
std::vector<GlObject> make_lightmap_textures(const LightmapLayout& layout,
                                             std::span<const glm::vec3> radiance);
/// The same without radiance, RGBA16F: for shaders that write it.
std::vector<GlObject> make_lightmap_textures(const LightmapLayout& layout);

} // namespace prt
