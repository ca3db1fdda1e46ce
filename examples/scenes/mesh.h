#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace examples {

struct Mesh {
    std::vector<glm::vec3> positions, normals;
    std::vector<std::uint32_t> indices;
};

inline constexpr float kTurn = 6.2831853f;

/// A grid of (columns + 1) x (rows + 1) vertices over (u, v) in [0, 1]², front where u x v points. Normals by
/// central differences of `surface`, which must be defined a little beyond [0, 1].
Mesh parametric_surface(int columns, int rows, const std::function<glm::vec3(float u, float v)>& surface);

/// A flat rectangle from `corner`, spanned by two edges, with vertices about `spacing` apart.
Mesh rectangle(const glm::vec3& corner, const glm::vec3& edge_u, const glm::vec3& edge_v, float spacing);

/// Appends `other` to `mesh`.
void append(Mesh& mesh, const Mesh& other);

} // namespace examples
