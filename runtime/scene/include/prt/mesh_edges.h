#pragma once

// The edges of a scene. Experimental.

#include "prt/adjacency.h"
#include "prt/scene.h"

#include <vector>

namespace prt {

/// Returns the edges of all triangles, as pairs of receivers, in ascending order without duplicates.
std::vector<Edge> mesh_edges(const Scene& scene);

} // namespace prt
