#pragma once

// Barycentric interpolation, and normals of triangles.

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace prt {

/// Interpolates the values of the triangle's corners `t` at barycentric coordinates `uv` of corners 1 and 2.
template <class T>
T interpolated(const std::vector<T>& values, const glm::uvec3& t, const glm::vec2& uv) {
    return values[t.x] * (1 - uv.x - uv.y) + values[t.y] * uv.x + values[t.z] * uv.y;
}

/// Returns the unit normal of the front of triangle `t`; zero without an area.
inline glm::vec3 plane_of(const std::vector<glm::vec3>& positions, const glm::uvec3& t) {
    const glm::dvec3 a(positions[t.x]),
        face = glm::cross(glm::dvec3(positions[t.y]) - a, glm::dvec3(positions[t.z]) - a);
    const double doubled = glm::length(face);
    return doubled > 0 ? glm::vec3(face / doubled) : glm::vec3(0);
}

/// Returns `v` with length 1, or `otherwise` if `v` is zero.
inline glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& otherwise) {
    const float length = glm::length(v);
    return length > 0 ? v / length : otherwise;
}

} // namespace prt
