#pragma once

#include "prt/scene.h"

namespace prt {

/// Gives `vertices` flat normals: vertices whose triangles face different ways are split, and `source` says
/// from which. Triangles without area keep a vertex with a zero normal.
void split_for_flat_normals(VertexArray& vertices, std::vector<glm::uvec3>& triangles);

/// Replaces zero normals by the area-weighted normal of the triangles at the vertex, where there is one.
/// Returns how many were replaced.
std::size_t replace_zero_normals(Scene& scene);

} // namespace prt
