#pragma once

// Textures over the surfaces of a scene, whose texels are receivers. Experimental.

#include "prt/lightmap.h"
#include "prt/scene.h"

#include <cstddef>
#include <vector>

namespace prt {

/// Assignment of surfaces to textures.
enum class AtlasMode {
    automatic, ///< all surfaces if their charts do not overlap, otherwise one texture per object
    one,       ///< one texture for all surfaces
    each,      ///< one texture per object, that is, per node of the file
};

/// Settings of textures.
struct TexelOptions {
    int size = 0;         ///< texels per side; 0: from `per_metre`
    double per_metre = 0; ///< mean number of texels per metre
    int uv_set = 1;       ///< TEXCOORD_n
    AtlasMode atlases = AtlasMode::automatic;
};

inline constexpr int kMaxTexels = 8192; ///< maximum number of texels per side

/// A texture over some primitives.
struct Atlas {
    std::vector<std::size_t> primitives; ///< indices into Scene::primitives
    int uv_set = 1;
    int width = 0, height = 0;
    bool repeats = false; ///< some coordinates are outside 0..1, where the texture repeats

    std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Returns the size of the atlas as a lightmap layout stores it.
inline LightmapSize size_of(const Atlas& atlas) {
    return {atlas.width, atlas.height, atlas.repeats};
}

/// Returns the textures for all surfaces of `scene`. Throws `Error` if texture coordinates are missing or
/// cross a border, if charts of one texture overlap, and if a texture would be too large.
std::vector<Atlas> plan_atlases(const Scene& scene, const TexelOptions& options);

} // namespace prt
