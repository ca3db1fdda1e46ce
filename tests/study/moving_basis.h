#pragma once

#include "sparse_grid.h"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace prt {

using RowMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline Eigen::Index eigen_index(std::size_t i) {
    return static_cast<Eigen::Index>(i);
}

/// Points to fit a moving basis to, in a space where squared distance is the error to minimise.
struct GridPoints {
    RowMatrix values;                     ///< [points][dimension]
    std::vector<float> significance;      ///< [points], sums to 1
    std::span<const glm::vec3> positions; ///< [points]
    int threads = 0;
};

/// f(p) = sum_n share_pn ( row_n0 + sum_l w_pl row_nl ) over the corners n of the cell of p.
struct MovingBasis {
    std::size_t components = 0;
    RowMatrix rows;    ///< [nodes][1 + components][dimension]: the mean of each node, then its basis
    RowMatrix weights; ///< [points][components]

    Eigen::Index rows_per_node() const { return static_cast<Eigen::Index>(components) + 1; }
};

/// Interpolates the rows at index `i` of grid.receivers, which is in `cell`: [1 + components][dimension].
void interpolate(const SparseGrid& grid, const MovingBasis& basis, const SparseGrid::Cell& cell,
                 std::size_t i, RowMatrix& rows);

/// [points][dimension], as rows and weights have it.
RowMatrix values_of(const GridPoints& points, const SparseGrid& grid, const MovingBasis& basis);
/// Mean squared distance of `values` by significance.
double squared_error(const GridPoints& points, const RowMatrix& values);

/// Returns for each component the mean squared length of its rows at receivers.
std::vector<double> energies_of(const GridPoints& points, const SparseGrid& grid, const MovingBasis& basis);

/// Returns the principal components of all points, equal at every node, with weights 0.
MovingBasis principal_components(const GridPoints& points, const SparseGrid& grid, std::size_t components);
/// Returns the basis on a grid whose cells are half as large, with equal values.
MovingBasis on_finer_grid(const MovingBasis& basis, const SparseGrid& coarse, const SparseGrid& fine);
/// The first `components` of the basis.
MovingBasis truncated(const MovingBasis& basis, std::size_t components);

/// Makes weights uncorrelated, with mean 0 and variance 1, and sorts components by energy, largest first. The
/// sum of the components does not change.
void normalise(const GridPoints& points, const SparseGrid& grid, MovingBasis& basis);

} // namespace prt
