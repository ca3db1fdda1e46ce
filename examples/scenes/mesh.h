#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace examples {

struct Mesh {
    std::vector<glm::vec3> positions, normals;
    std::vector<std::uint32_t> indices;
};

struct Part {
    std::string name;
    glm::vec3 color; ///< linear base color
    Mesh mesh;
    /// Of a leaf: the share of the light that passes, and its color. Above 0 the part is double-sided.
    float transmission = 0;
    glm::vec3 transmission_color{1};
};

using ExampleScene = std::vector<Part>;

/// A grid of (columns + 1) x (rows + 1) vertices over (u, v) in [0, 1]², front where u x v points. Normals by
/// central differences of `surface`, which must be defined a little beyond [0, 1].
Mesh parametric_surface(int columns, int rows, const std::function<glm::vec3(float u, float v)>& surface);

/// A flat rectangle from `corner`, spanned by two edges, with vertices about `spacing` apart.
Mesh rectangle(const glm::vec3& corner, const glm::vec3& edge_u, const glm::vec3& edge_v, float spacing);

/// Appends `other` to `mesh`.
void append(Mesh& mesh, const Mesh& other);

ExampleScene torus_knot_over_plane();
ExampleScene room_with_columns();
ExampleScene terrain();
/// A tree in full leaf: light comes through the leaves.
ExampleScene tree();
/// Some 15 000 buildings of 1.5 million vertices and 1.8 million triangles, to measure with.
ExampleScene city();

} // namespace examples
