#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace prt {

/// Two unit vectors across unit `axis`, and across each other.
struct Across {
    glm::dvec3 x, y;

    explicit Across(const glm::dvec3& axis)
        : x(glm::normalize(
              glm::cross(axis, std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)))),
          y(glm::cross(axis, x)) {}
};

} // namespace prt
