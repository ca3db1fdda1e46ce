#pragma once

// Creates texture coordinates without overlaps for all surfaces of a scene. Experimental.

#include "prt/scene.h"
#include "prt/texels.h"
#include "prt/vertex_splits.h"

#include <cstddef>
#include <vector>

namespace prt {

/// New texture coordinates of a scene.
struct Unwrapping {
    std::vector<VertexSplit> primitives; ///< [scene's primitives]
    std::vector<Atlas> atlases;          ///< the textures; the caller sets their `uv_set`
    std::size_t charts = 0;
    double texels_per_metre = 0; ///< minimum over all textures
};

/// Cuts surfaces into charts whose triangles face mainly along the same axis, so that no chart overlaps
/// itself, and packs the charts with at least two texels between them. Throws `Error` if a texture is too
/// small for the charts.
Unwrapping unwrap(const Scene& scene, const TexelOptions& options);

} // namespace prt
