#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

inline constexpr std::size_t kCorners = 8;

/// A regular grid over positions between whose nodes is interpolated linearly along each axis. Of its cells
/// and nodes those are there that a receiver needs.
struct SparseGrid {
    struct Cell {
        std::array<std::uint32_t, kCorners> nodes; ///< x fastest, then y; the first again for one not needed
        std::size_t begin = 0, end = 0;            ///< its `receivers`
    };
    double size = 0;                      ///< edge of a cell, metres
    std::vector<Cell> cells;              ///< none empty, in order of z, y, x
    std::vector<std::uint32_t> receivers; ///< cell by cell
    std::vector<std::array<float, kCorners>>
        share;                     ///< [receivers] of their order: of each corner; their sum 1
    std::vector<glm::ivec3> nodes; ///< place of each, in edges from the least corner of all
    std::size_t nodes_of_box = 0;  ///< needed or not
};

/// The grid with cells of `size` from the least corner of the box around `positions` on.
SparseGrid sparse_grid(std::span<const glm::vec3> positions, double size);

/// The longest edge of the box around `positions`; 0 where they are one.
double longest_edge(std::span<const glm::vec3> positions);

/// For each node of `fine` its corners in `coarse`, whose cells are twice as large, and their shares.
struct CoarseCorners {
    std::array<std::uint32_t, kCorners> nodes;
    std::array<float, kCorners> share;
};
std::vector<CoarseCorners> corners_in(const SparseGrid& coarse, const SparseGrid& fine);

} // namespace prt
