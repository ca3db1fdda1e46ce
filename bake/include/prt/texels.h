#pragma once

// Textures over the surfaces of a scene, whose texels are receivers. Experimental.

#include "prt/lightmap.h"
#include "prt/scene.h"

#include <cstddef>
#include <vector>

namespace prt {

/// Which surfaces share a texture.
enum class AtlasMode {
    automatic, ///< all where their charts do not overlap, otherwise each object has its own
    one,       ///< all
    each,      ///< each object, that is each node of the file
};

struct TexelOptions {
    int size = 0;         ///< texels along each side; 0: by `per_metre`
    double per_metre = 0; ///< texels along a metre, in the mean
    int uv_set = 1;       ///< TEXCOORD_n
    AtlasMode atlases = AtlasMode::automatic;
};

inline constexpr int kMostTexels = 8192; ///< along a side

/// A texture over some primitives.
struct Atlas {
    std::vector<std::size_t> primitives; ///< indices into Scene::primitives
    int uv_set = 1;
    int width = 0, height = 0;
    bool repeats = false; ///< some coordinates lie in other squares than 0..1, where the texture goes on

    std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

inline LightmapSize size_of(const Atlas& atlas) {
    return {atlas.width, atlas.height, atlas.repeats};
}

/// Throws `Error` where coordinates are missing or cross a border, where charts of one texture overlap, and
/// where a texture would be too large.
std::vector<Atlas> plan_atlases(const Scene& scene, const TexelOptions& options);

} // namespace prt
