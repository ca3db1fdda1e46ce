#pragma once

// Normals of triangles.

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace prt {

/// Returns twice the area times the unit normal, in double so that tiny triangles keep their direction.
inline glm::dvec3 area_normal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::cross(b - a, c - a);
}

inline glm::vec3 unit_or_zero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : glm::vec3(0);
}

} // namespace prt
