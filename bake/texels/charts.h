#pragma once

// The triangles of an atlas where they lie in it.

#include "prt/texels.h"

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace prt {

/// In texels: texel (i, j) is the square from (i, j) on.
struct ChartTriangle {
    std::uint32_t triangle; ///< in the order of the scene's primitives and their triangles
    std::array<glm::dvec2, 3> corners;
};

/// Throws `Error` where a primitive lacks the coordinates, and where a triangle crosses the border of the
/// texture. Those that lie in another square than 0..1 as a whole are where the texture repeats.
std::vector<ChartTriangle> chart_triangles(const Scene& scene, const Atlas& atlas);
/// Whether some do.
bool repeats(const Scene& scene, const Atlas& atlas);

/// Barycentric coordinates of corners 1 and 2 of `point`, and the least distance to an edge, positive inside.
/// Of triangles without an area the distance is negative.
struct InTriangle {
    glm::dvec2 uv{0};
    double depth = -1;
};
InTriangle in_triangle(const ChartTriangle& triangle, const glm::dvec2& point);

/// The point of the triangle that is nearest to `point`: barycentric coordinates of corners 1 and 2.
glm::dvec2 nearest_in_triangle(const ChartTriangle& triangle, const glm::dvec2& point);

inline glm::dvec2 place_of(const ChartTriangle& t, const glm::dvec2& uv) {
    return t.corners[0] * (1 - uv.x - uv.y) + t.corners[1] * uv.x + t.corners[2] * uv.y;
}

} // namespace prt
