#pragma once

// Triangles of an atlas in texel coordinates.

#include "prt/bake/texels.h"

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace prt {

/// A triangle in texel coordinates: texel (i, j) is the square from (i, j) to (i + 1, j + 1).
struct ChartTriangle {
    std::uint32_t triangle; ///< in the order of the scene's primitives and their triangles
    std::array<glm::dvec2, 3> corners;
};

/// Returns the triangles of the atlas. Throws `Error` if a primitive lacks the coordinates, or if a triangle
/// crosses the border of the texture. Triangles that are completely in another square than 0..1 are in a
/// repetition of the texture.
std::vector<ChartTriangle> chart_triangles(const Scene& scene, const Atlas& atlas);
/// Returns whether any triangle is in a repetition of the texture.
bool repeats(const Scene& scene, const Atlas& atlas);

/// Barycentric coordinates of corners 1 and 2 of `point`, and the minimum distance to an edge, positive
/// inside. The distance is negative for triangles without area.
struct InTriangle {
    glm::dvec2 uv{0};
    double depth = -1;
};
InTriangle in_triangle(const ChartTriangle& triangle, const glm::dvec2& point);

/// Returns the point of the triangle that is nearest to `point`, as barycentric coordinates of corners 1 and
/// 2.
glm::dvec2 nearest_in_triangle(const ChartTriangle& triangle, const glm::dvec2& point);

inline glm::dvec2 position_of(const ChartTriangle& t, const glm::dvec2& uv) {
    return t.corners[0] * (1 - uv.x - uv.y) + t.corners[1] * uv.x + t.corners[2] * uv.y;
}

} // namespace prt
