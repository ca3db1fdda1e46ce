#pragma once

// Creates texture coordinates without overlaps for all surfaces of a scene. Experimental.

#include "bake/gltf/vertex_splits.h"
#include "prt/bake/texels.h"
#include "prt/load/scene.h"

#include <cstddef>
#include <vector>

namespace prt {

/// New texture coordinates (UVs) of a scene. Vertices at the borders of charts are split.
struct Unwrapping {
    std::vector<VertexSplit> primitives; ///< [Scene::primitives] new vertices, UVs and triangles
    /// The textures that the UVs refer to. `uv_set` has its default value: the caller sets it to the UV set
    /// in which `with_texcoords` (bake/gltf/vertex_splits.h) stores the UVs.
    std::vector<Atlas> atlases;
    std::size_t charts = 0;      ///< number of charts in all textures
    double texels_per_metre = 0; ///< number of texels per metre along an axis, minimum over all textures;
                                 ///< infinity if the scene has no primitives
};

/// Creates texture coordinates without overlaps, and ignores the existing ones. Cuts surfaces into charts
/// whose triangles face mainly along the same coordinate axis, projects each chart along this axis, and packs
/// the charts into square textures, with at least two empty texels next to every side of a chart. `options`:
/// AtlasMode::automatic means one texture; `uv_set` is ignored. `size` must be in 1..kMaxTexels, or 0 with a
/// `per_metre` that is finite and greater than 0; these ranges are not checked. With `size`, the charts get
/// approximately the highest resolution that fits. Throws `Error` if a texture of this size is too small for
/// the charts, or if `per_metre` needs more than kMaxTexels per side.
Unwrapping unwrap(const Scene& scene, const TexelOptions& options);

} // namespace prt
