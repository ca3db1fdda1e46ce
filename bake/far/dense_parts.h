#pragma once

// Which meshes of a scene are dense: small and of many triangles, as trees are.

#include "prt/scene.h"

#include <vector>

namespace prt {

struct DenseParts {
    std::vector<bool> primitives; ///< [primitives of the scene]
    std::vector<Bounds> nodes;    ///< box round each
    std::size_t triangles = 0;
    Bounds all{}; ///< box round all of them
};

/// Primitives of nodes whose box has a diagonal of at most `distance` and is not flat as a wall's, and that
/// have so many triangles that it is worth it.
DenseParts find_dense_parts(const Scene& scene, float distance);

} // namespace prt
