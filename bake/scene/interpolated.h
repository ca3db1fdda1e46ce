#pragma once

// Barycentric interpolation.

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace prt {

/// Interpolates the values of the triangle's corners `t` at barycentric coordinates `uv` of corners 1 and 2.
template <class T>
T interpolated(const std::vector<T>& values, const glm::uvec3& t, const glm::vec2& uv) {
    return values[t.x] * (1 - uv.x - uv.y) + values[t.y] * uv.x + values[t.z] * uv.y;
}

} // namespace prt
