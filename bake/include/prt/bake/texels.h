#pragma once

// Plans lightmaps: textures over the surfaces of a scene, whose texels are receivers. Experimental.

#include "prt/core/lightmap.h"
#include "prt/load/scene.h"

#include <cstddef>
#include <vector>

namespace prt {

/// Assignment of surfaces to textures. An object is a node of the glTF file.
enum class AtlasMode {
    automatic, ///< one texture for all surfaces if their charts do not overlap, otherwise one texture per
               ///< object; `unwrap` always creates one texture
    one,       ///< one texture for all surfaces; an error if charts overlap
    each,      ///< one texture per object; an error if charts of one object overlap
};

/// Settings for the size of textures, and for the surfaces that share one.
struct TexelOptions {
    int size = 0;         ///< texels per side of every texture, 1..kMaxTexels; 0: `per_metre` determines it
    double per_metre = 0; ///< texels per metre along an axis, on average over a texture; used only if `size`
                          ///< is 0, then finite and greater than 0; a texture has at least 4 texels per side
    int uv_set = 1;       ///< n of the existing UV set TEXCOORD_n; `unwrap` ignores it
    AtlasMode atlases = AtlasMode::automatic; ///< surfaces that share a texture
    bool leave_out_lobes = false; ///< whether surfaces with lobes (VertexArray::lobes) get no texels
};

inline constexpr int kMaxTexels = 8192; ///< maximum number of texels per side of a texture

/// A texture that some primitives share.
struct Atlas {
    std::vector<std::size_t> primitives; ///< indices into Scene::primitives, ascending
    int uv_set = 1;                      ///< n of the UV set TEXCOORD_n of these primitives
    int width = 0,                       ///< number of texels along u
        height = 0;                      ///< number of texels along v
    bool repeats = false; ///< true: the UVs of some triangles are outside 0..1, where the texture repeats

    std::size_t texels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Returns the size of `atlas` in the form that LightmapLayout::maps stores.
inline LightmapSize size_of(const Atlas& atlas) {
    return {atlas.width, atlas.height, atlas.repeats};
}

/// Returns the primitives that get texels, in ascending order.
std::vector<std::size_t> surfaces_with_texels(const Scene& scene, const TexelOptions& options);

/// Returns square textures that together contain every primitive of `scene` once, with their existing UV set.
/// `scene` must have a triangle. Throws `Error` for options out of range, for primitives without this UV set,
/// if the UVs of a triangle cross the border of the texture, if the UVs of a texture have no area, if more
/// than 0.1 % of the area of the charts of a texture overlaps, and if `per_metre` needs more than kMaxTexels
/// per side. With AtlasMode::automatic, all these errors, except overlaps, also apply to one texture for all
/// surfaces.
std::vector<Atlas> plan_atlases(const Scene& scene, const TexelOptions& options);

} // namespace prt
