#pragma once

// The edges of a scene. Experimental.

#include "prt/adjacency.h"
#include "prt/scene.h"

#include <vector>

namespace prt {

/// Returns the edges of all triangles between receivers, without duplicates, in ascending order.
std::vector<Edge> mesh_edges(const Scene& scene);

} // namespace prt
