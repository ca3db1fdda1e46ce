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

/// Returns a grid of (columns + 1) x (rows + 1) vertices over (u, v) in [0, 1]², with its front side towards
/// u x v. Normals are central differences of `surface`, which must be defined slightly beyond [0, 1]. Texture
/// coordinates are (u, 1 - v): a picture is upright if v points up.
Mesh parametric_surface(int columns, int rows, const std::function<glm::vec3(float u, float v)>& surface);

/// Returns a flat rectangle from `corner`, spanned by two edges, with a spacing of about `spacing` between
/// vertices. Texture coordinates are in metres.
Mesh rectangle(const glm::vec3& corner, const glm::vec3& edge_u, const glm::vec3& edge_v, float spacing);

/// Appends `other` to `mesh`.
void append(Mesh& mesh, const Mesh& other);

/// Returns `mesh` transformed by a rigid transform.
Mesh placed(Mesh mesh, const glm::mat4& transform);

/// Returns a rotation about +Y (counter-clockwise seen from above) followed by a translation.
glm::mat4 placement(const glm::vec3& origin, float degrees);

/// Texture coordinates times `factor`.
Mesh with_scaled_texcoords(Mesh mesh, const glm::vec2& factor);

} // namespace examples
