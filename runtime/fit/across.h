#pragma once

// Axes orthogonal to a direction.

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace prt {

/// Two unit vectors that are orthogonal to unit `axis` and to each other.
struct Across {
    glm::dvec3 x, y;

    explicit Across(const glm::dvec3& axis)
        : x(glm::normalize(
              glm::cross(axis, std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)))),
          y(glm::cross(axis, x)) {}
};

} // namespace prt
