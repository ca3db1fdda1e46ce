#pragma once

// Flat normals for vertices without normals.

#include "prt/load/scene.h"

namespace prt {

/// Computes flat normals of `vertices`. Vertices whose triangles face different directions are split, and
/// `source` stores the original vertex. Triangles without area keep a vertex with a zero normal.
void split_for_flat_normals(VertexArray& vertices, std::vector<glm::uvec3>& triangles);

/// Replaces zero normals by the area-weighted normal of the triangles at the vertex, if it is not zero.
/// Returns the number of replaced normals.
std::size_t replace_zero_normals(Scene& scene);

} // namespace prt
