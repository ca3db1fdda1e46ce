#pragma once

// Places of their own in a texture for all surfaces of a scene. Experimental.

#include "prt/scene.h"
#include "prt/texels.h"
#include "prt/vertex_splits.h"

#include <cstddef>
#include <vector>

namespace prt {

struct Unwrapping {
    std::vector<VertexSplit> primitives; ///< [scene's primitives]
    std::vector<Atlas> atlases;          ///< whose set of coordinates is the caller's to say
    std::size_t charts = 0;
    double texels_per_metre = 0; ///< the least of all textures
};

/// Cuts surfaces into charts by the axis that they face most, so that no two places of one overlap, and packs
/// the charts, two texels apart from one another at least. Throws `Error` where a texture is too small for
/// them.
Unwrapping unwrap(const Scene& scene, const TexelOptions& options);

} // namespace prt
