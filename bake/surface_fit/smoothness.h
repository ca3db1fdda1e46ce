#pragma once

// Second differences of a function across the edges of a mesh.

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// A triangle with its unknowns.
struct FitTriangle {
    std::array<std::uint32_t, 3> unknowns;
    std::array<glm::dvec3, 3> corners;
};

/// The second difference of a function x across an edge, Σ factors_i x_i over the corners of the two
/// triangles that share it: h (∂x/∂n + ∂x/∂n'), where ∂/∂n are the slopes in their planes away from the edge,
/// and h is the harmonic mean of their heights over it. It is zero if x is linear over the unfolded triangles
/// (Kavan, Bargteil and Sloan 2011, multiplied by h, so that it does not depend on the size of triangles).
struct SecondDifference {
    std::array<std::uint32_t, 4> unknowns;
    std::array<float, 4> factors;
    float area; ///< area of the two triangles, m²
};

/// Returns the second differences of all edges that two triangles share.
std::vector<SecondDifference> second_differences_of(std::span<const FitTriangle> triangles);

} // namespace prt
