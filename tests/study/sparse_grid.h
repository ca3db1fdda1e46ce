#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

inline constexpr std::size_t kCorners = 8;

/// A regular grid over positions with linear interpolation along each axis. It stores only the cells and
/// nodes that a receiver uses.
struct SparseGrid {
    struct Cell {
        std::array<std::uint32_t, kCorners> nodes; ///< x fastest, then y; the first again for one not needed
        std::size_t begin = 0, end = 0;            ///< its `receivers`
    };
    double size = 0;                                ///< edge of a cell, metres
    std::vector<Cell> cells;                        ///< non-empty cells, in order of z, y, x
    std::vector<std::uint32_t> receivers;           ///< cell by cell
    std::vector<std::array<float, kCorners>> share; ///< [receivers] in their order: interpolation weights of
                                                    ///< the corners; their sum is 1
    std::vector<glm::ivec3> nodes; ///< position of each, in edges from the minimum corner of the grid
    std::size_t nodes_of_box = 0;  ///< needed or not
};

/// Returns the grid with cells of `size`, which starts at the minimum corner of the box around `positions`.
SparseGrid sparse_grid(std::span<const glm::vec3> positions, double size);

/// The longest edge of the box around `positions`; 0 where they are one.
double longest_edge(std::span<const glm::vec3> positions);

/// Corners in `coarse` of each node of `fine`, whose cells are half as large, and their weights.
struct CoarseCorners {
    std::array<std::uint32_t, kCorners> nodes;
    std::array<float, kCorners> share;
};
std::vector<CoarseCorners> corners_in(const SparseGrid& coarse, const SparseGrid& fine);

} // namespace prt
