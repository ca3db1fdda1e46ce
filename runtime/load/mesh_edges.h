#pragma once

// The edges of a scene. Experimental.

#include "prt/core/adjacency.h"
#include "prt/load/scene.h"

#include <vector>

namespace prt {

/// Returns the edges of all triangles of all primitives, in ascending order, without duplicates and without
/// edges from a vertex to itself. The ends of an edge are indices of receivers. Vertices at the same position
/// are different receivers.
std::vector<Edge> mesh_edges(const Scene& scene);

} // namespace prt
