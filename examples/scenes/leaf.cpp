// Builds the mesh of a leaf.

#include "leaf.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace examples {

Mesh leaf(const glm::vec3& base, const glm::vec3& along, const glm::vec3& side, float length, int columns,
          int rows) {
    const glm::vec3 up = glm::cross(side, along);
    return parametric_surface(columns, rows, [&](float u, float v) {
        const float across = 2 * u - 1, width = 0.32f * std::sin(3.14159265f * (0.03f + 0.94f * v));
        return base +
               length * (v * along + width * across * side + (0.12f * std::abs(across) - 0.25f * v * v) * up);
    });
}

} // namespace examples
