#pragma once

// Triangles of primitives.

#include "runtime/load/gltf_model.h"

#include <glm/vec3.hpp>

#include <vector>

namespace prt {

/// Returns whether a primitive mode is triangles, a strip or a fan. A missing mode is triangles.
bool is_triangle_mode(int mode);

/// Returns the triangles of a primitive with `vertices` vertices; strips and fans are split with correct
/// winding. Throws `Error` for an index beyond the vertices.
std::vector<glm::uvec3> read_triangles(const GltfModel& model, const GltfPrimitive& primitive,
                                       std::size_t vertices);

} // namespace prt
