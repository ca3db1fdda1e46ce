#pragma once

#include "mesh.h"

#include <string>

namespace examples {

struct Part {
    std::string name;
    glm::vec3 color; ///< linear base color
    Mesh mesh;
    /// Of a leaf: the share of the light that passes, and its color. Above 0 the part is double-sided.
    float transmission = 0;
    glm::vec3 transmission_color{1};
};

using ExampleScene = std::vector<Part>;

ExampleScene torus_knot_over_plane();
ExampleScene room_with_columns();
ExampleScene terrain();
/// A tree in full leaf: light comes through the leaves.
ExampleScene tree();
/// Some 15 000 buildings of 1.5 million vertices and 1.8 million triangles, to measure with.
ExampleScene city();

} // namespace examples
