#pragma once

// Sums over square images: the faces of a cube, and angular maps (docs/math.md, section 3).
//
// In the frame of a square (x right, y down, z the direction of its center) the basis functions are even or
// odd in x and in y. The basis is therefore integrated over the texels of a quarter only, once for all faces.
// Four mirrored pixels are combined with their signs before the multiplication. A final rotation per face
// maps to the world.

#include "runtime/core/light/projection.h"
#include "runtime/core/support/parallel.h"
#include "runtime/core/support/vector_lanes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace prt {

/// An interval along one axis, in coordinates [-1, 1] of a square.
struct Cell {
    double begin, end;

    double at(double node) const { return 0.5 * (begin + end + (end - begin) * node); }
    double half() const { return 0.5 * (end - begin); }
};

inline Cell even_cell(int size, int i) {
    return {2.0 * i / size - 1, 2.0 * (i + 1) / size - 1};
}

/// A direction in the frame of the square, and its solid angle.
struct Node {
    glm::dvec3 direction;
    double weight;
};

/// The basis integrated over the texels of half a row; the stride is a multiple of the lanes.
struct RowOfTexels {
    std::size_t count, stride, points;
    std::vector<glm::vec3> directions; ///< [points][stride]
    std::vector<float> weights;        ///< [points][stride]
    std::vector<float> basis;          ///< [order²][points][stride]
    std::vector<float> texels;         ///< [order²][stride]

    RowOfTexels(int order, std::size_t texels_of_row, std::size_t points_of_texel)
        : count(texels_of_row), stride((count + kLaneCount - 1) / kLaneCount * kLaneCount),
          points(points_of_texel), directions(points * stride, glm::vec3(0, 0, 1)),
          weights(points * stride, 0.0f),
          basis(static_cast<std::size_t>(coefficient_count(order)) * points * stride),
          texels(static_cast<std::size_t>(coefficient_count(order)) * stride) {}

    void put(std::size_t texel, std::size_t point, const Node& node) {
        directions[point * stride + texel] = glm::vec3(node.direction);
        weights[point * stride + texel] = static_cast<float>(node.weight);
    }
    /// Computes `texels` from directions and weights.
    void integrate(int order);
};

/// Computes sums of four mirrored pixels of rows `row` and size - 1 - row: even or odd in x, even or odd in
/// y. [2 y + x][channel][stride]
void fold(const glm::vec3* above, const glm::vec3* below, int size, int row, std::size_t stride,
          float* parts);

/// Partial sums of the products of functions and pixels, one per lane.
inline constexpr std::size_t kSumLanes = 8;
struct LaneSums {
    float at[kMaxOrder * kMaxOrder][3][kSumLanes] = {};
};

/// Indices of the functions, grouped by their symmetry in x and y. cos(m phi) is even in y and, for even m,
/// in x; sin(m phi) is odd in y and, for odd m, even in x.
struct BySigns {
    std::array<std::size_t, kMaxOrder * kMaxOrder> index;
    std::array<std::size_t, 5> first{}; ///< first index of part 2 odd_y + odd_x

    explicit BySigns(int order) {
        std::size_t count = 0;
        for (std::size_t part = 0; part < 4; ++part) {
            for (int l = 0; l < order; ++l)
                for (int m = -l; m <= l; ++m) {
                    const bool odd_y = m < 0, odd_x = (m % 2 != 0) != odd_y;
                    if (part == std::size_t{2} * odd_y + odd_x)
                        index[count++] = static_cast<std::size_t>(sh_index(l, m));
                }
            first[part + 1] = count;
        }
    }
};

/// Adds the products of every function with the part of the same symmetry.
void multiply_parts(const BySigns& functions, std::size_t stride, const float* texels, const float* parts,
                    LaneSums& sums);

/// Adds the products of all functions with one part.
void multiply_all(const BySigns& functions, std::size_t stride, const float* texels, const float* part,
                  LaneSums& sums);

void add_lanes(std::size_t functions, const LaneSums& sums, ProjectedColors& result);

/// Adds `square`, with axes `right`, `down` and `outward`, to `result`.
void add_square(const ProjectedColors& square, const glm::dvec3& right, const glm::dvec3& down,
                const glm::dvec3& outward, int order, ProjectedColors& result);

/// Number of rows that are summed in float, and number of row blocks that share memory.
inline constexpr std::size_t kRowsOfBlock = 8, kBlocksOfTask = 2;

/// Projects the squares of `size` pixels in a column, each in its own frame. `put_row(row, texels)` writes
/// directions and weights; `fold_row(square, row, stride, parts)` folds pixels.
template <class PutRow, class FoldRow>
std::vector<ProjectedColors> project_squares(int size, int squares, std::size_t points, int order,
                                             int threads, PutRow&& put_row, FoldRow&& fold_row) {
    const auto half = static_cast<std::size_t>((size + 1) / 2), columns = static_cast<std::size_t>(squares);
    const auto functions = static_cast<std::size_t>(coefficient_count(order));
    const std::size_t blocks = (half + kRowsOfBlock - 1) / kRowsOfBlock;
    const BySigns by_signs(order);
    std::vector<ProjectedColors> sums(blocks * columns);
    parallel_for(blocks, kBlocksOfTask, threads, [&](std::size_t begin, std::size_t end) {
        RowOfTexels row(order, half, points);
        std::vector<float> parts(12 * row.stride, 0.0f);
        for (std::size_t block = begin; block < end; ++block) {
            std::vector<LaneSums> lanes(columns);
            for (std::size_t y = block * kRowsOfBlock; y < std::min(half, (block + 1) * kRowsOfBlock); ++y) {
                put_row(static_cast<int>(y), row);
                row.integrate(order);
                for (std::size_t square = 0; square < columns; ++square) {
                    fold_row(static_cast<int>(square), static_cast<int>(y), row.stride, parts.data());
                    multiply_parts(by_signs, row.stride, row.texels.data(), parts.data(), lanes[square]);
                }
            }
            for (std::size_t square = 0; square < columns; ++square)
                add_lanes(functions, lanes[square], sums[block * columns + square]);
        }
    });
    std::vector<ProjectedColors> result(columns);
    for (std::size_t block = 0; block < blocks; ++block)
        for (std::size_t square = 0; square < columns; ++square)
            for (std::size_t i = 0; i < functions; ++i)
                result[square][i] += sums[block * columns + square][i];
    return result;
}

} // namespace prt
