#pragma once

#include <glm/vec3.hpp>
#include <tiny_gltf.h>

#include <vector>

namespace prt {

/// Whether a primitive mode is triangles, a strip or a fan. An absent mode is triangles.
bool is_triangle_mode(int mode);

/// The triangles of a primitive with `vertices` vertices, strips and fans taken apart with their winding
/// kept. Throws `Error` for an index beyond the vertices.
std::vector<glm::uvec3> read_triangles(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                       std::size_t vertices);

} // namespace prt
