#pragma once

// Edges of a scene by position, independent of vertices.

#include "prt/load/scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace prt {

inline constexpr std::uint32_t kNoEdge = ~0u;

/// Triangles in one list, in the order of the scene's primitives, and their edges. All edges between the same
/// two positions are one edge, so that adjacent triangles are split in the same way across seams of materials
/// and texture coordinates, and across nodes.
struct WeldedEdges {
    /// An edge between two vertices of an array; at seams several of them are one welded edge.
    struct Sides {
        std::uint32_t array, first, second; ///< first < second
        std::uint32_t edge;
    };
    std::vector<std::array<std::uint32_t, 3>> of_triangle; ///< edge from corner i to the next; kNoEdge: no
                                                           ///< length
    std::vector<std::array<std::uint32_t, 3>> sides_of_triangle; ///< the same edges as indices of `sides`
    std::vector<std::uint8_t> longest; ///< [triangles] index 0..2 of the longest edge; edges of equal length
                                       ///< have a fixed order
    std::vector<double> lengths;       ///< [edges] metres
    std::vector<Sides> sides;          ///< by array, first and second
};

WeldedEdges welded_edges(const Scene& scene);

} // namespace prt
