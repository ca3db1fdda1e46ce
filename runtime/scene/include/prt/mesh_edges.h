#pragma once

// The edges of a scene. Experimental.

#include "prt/adjacency.h"
#include "prt/scene.h"

#include <vector>

namespace prt {

/// The edges of all triangles between receivers, each once, in ascending order.
std::vector<Edge> mesh_edges(const Scene& scene);

} // namespace prt
