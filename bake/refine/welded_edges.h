#pragma once

// The edges of a scene, whatever vertices they are made of.

#include "prt/scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace prt {

inline constexpr std::uint32_t kNoEdge = ~0u;

/// Triangles in one list, in the order of the scene's primitives, and their edges: all that lie between the
/// same two places are one, so that what touches is split alike across seams of materials and texture
/// coordinates, and across nodes.
struct WeldedEdges {
    /// An edge between two vertices of an array: where seams meet, several are one edge.
    struct Sides {
        std::uint32_t array, first, second; ///< first < second
        std::uint32_t edge;
    };
    std::vector<std::array<std::uint32_t, 3>> of_triangle; ///< from corner i to the next; kNoEdge: no length
    std::vector<std::array<std::uint32_t, 3>> sides_of_triangle; ///< the same, as indices of `sides`
    std::vector<std::uint8_t> longest; ///< [triangles] which of the three edges; equal ones by a fixed order
    std::vector<double> lengths;       ///< [edges] metres
    std::vector<Sides> sides;          ///< by array, first and second
};

WeldedEdges welded_edges(const Scene& scene);

} // namespace prt
