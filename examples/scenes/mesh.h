#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace examples {

/// Texture coordinates are there for every vertex; a part without a picture does not write them.
struct Mesh {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> texcoords;
    std::vector<std::uint32_t> indices;
};

inline constexpr float kTurn = 6.2831853f;

/// A grid of (columns + 1) x (rows + 1) vertices over (u, v) in [0, 1]², front where u x v points. Normals by
/// central differences of `surface`, which must be defined a little beyond [0, 1]. Texture coordinates are
/// (u, 1 - v): a picture stands upright where v points up.
Mesh parametric_surface(int columns, int rows, const std::function<glm::vec3(float u, float v)>& surface);

/// A flat rectangle from `corner`, spanned by two edges, with vertices about `spacing` apart. Texture
/// coordinates are in metres.
Mesh rectangle(const glm::vec3& corner, const glm::vec3& edge_u, const glm::vec3& edge_v, float spacing);

/// Appends `other` to `mesh`.
void append(Mesh& mesh, const Mesh& other);

/// `mesh` turned and moved by a rigid transform.
Mesh placed(Mesh mesh, const glm::mat4& transform);

/// Turned about +Y, counter-clockwise seen from above, then moved.
glm::mat4 placement(const glm::vec3& origin, float degrees);

/// Texture coordinates times `factor`.
Mesh with_scaled_texcoords(Mesh mesh, const glm::vec2& factor);

} // namespace examples
