// A basis that varies over space: its values, and equivalent forms of the basis.

#include "moving_basis.h"

#include "runtime/core/support/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

using Index = Eigen::Index;

Eigen::Map<const Eigen::VectorXf> significances_of(const GridPoints& points) {
    return {points.significance.data(), eigen_index(points.significance.size())};
}

/// The mean by significance, and the covariance about it.
struct Spread {
    Eigen::VectorXf mean;
    Eigen::MatrixXf covariance;
};

Spread spread_of(const GridPoints& points, const RowMatrix& vectors) {
    const Eigen::Map<const Eigen::VectorXf> a = significances_of(points);
    Spread spread{vectors.transpose() * a, {}};
    const RowMatrix centred = vectors.rowwise() - spread.mean.transpose();
    spread.covariance = centred.transpose() * a.asDiagonal() * centred;
    return spread;
}

/// Calls `use(i, rows)` for every index of grid.receivers with its interpolated rows.
template <class Use>
void for_rows(const SparseGrid& grid, const MovingBasis& basis, Use&& use) {
    RowMatrix rows;
    for (const SparseGrid::Cell& cell : grid.cells)
        for (std::size_t i = cell.begin; i < cell.end; ++i) {
            interpolate(grid, basis, cell, i, rows);
            use(i, rows);
        }
}

/// Transforms weights to to^T (w - mean), bases to from^T B and means to M + mean^T B.
void change_weights(MovingBasis& basis, const Eigen::VectorXf& mean, const Eigen::MatrixXf& to,
                    const Eigen::MatrixXf& from) {
    const Index rows = basis.rows_per_node();
    for (Index first = 0; first < basis.rows.rows(); first += rows) {
        const RowMatrix old = basis.rows.middleRows(first + 1, rows - 1);
        basis.rows.row(first) += mean.transpose() * old;
        basis.rows.middleRows(first + 1, rows - 1) = from.transpose() * old;
    }
    basis.weights = RowMatrix((basis.weights.rowwise() - mean.transpose()) * to);
}

} // namespace

void interpolate(const SparseGrid& grid, const MovingBasis& basis, const SparseGrid::Cell& cell,
                 std::size_t i, RowMatrix& rows) {
    const Index count = basis.rows_per_node();
    rows.setZero(count, basis.rows.cols());
    for (std::size_t corner = 0; corner < kCorners; ++corner)
        if (grid.share[i][corner] > 0)
            rows += grid.share[i][corner] * basis.rows.middleRows(cell.nodes[corner] * count, count);
}

RowMatrix values_of(const GridPoints& points, const SparseGrid& grid, const MovingBasis& basis) {
    RowMatrix values(points.values.rows(), points.values.cols());
    parallel_for(grid.cells.size(), 8, points.threads, [&](std::size_t begin, std::size_t end) {
        RowMatrix rows;
        for (std::size_t c = begin; c < end; ++c)
            for (std::size_t i = grid.cells[c].begin; i < grid.cells[c].end; ++i) {
                const Index p = grid.receivers[i];
                interpolate(grid, basis, grid.cells[c], i, rows);
                values.row(p) =
                    rows.row(0) + basis.weights.row(p) * rows.bottomRows(basis.rows_per_node() - 1);
            }
    });
    return values;
}

double squared_error(const GridPoints& points, const RowMatrix& values) {
    double error = 0;
    for (Index p = 0; p < values.rows(); ++p)
        error += static_cast<double>(points.significance[static_cast<std::size_t>(p)]) *
                 static_cast<double>((points.values.row(p) - values.row(p)).squaredNorm());
    return error;
}

std::vector<double> energies_of(const GridPoints& points, const SparseGrid& grid, const MovingBasis& basis) {
    std::vector<double> energies(basis.components, 0.0);
    for_rows(grid, basis, [&](std::size_t i, const RowMatrix& rows) {
        const double a = static_cast<double>(points.significance[grid.receivers[i]]);
        for (std::size_t l = 0; l < basis.components; ++l)
            energies[l] += a * static_cast<double>(rows.row(eigen_index(l) + 1).squaredNorm());
    });
    return energies;
}

MovingBasis principal_components(const GridPoints& points, const SparseGrid& grid, std::size_t components) {
    const Spread spread = spread_of(points, points.values);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> solver(spread.covariance);
    RowMatrix node(eigen_index(components) + 1, points.values.cols());
    node.row(0) = spread.mean.transpose();
    for (Index l = 0; l < eigen_index(components); ++l) {
        const Index axis = node.cols() - 1 - l; // eigenvalues ascend
        node.row(l + 1) = std::sqrt(std::max(0.0f, solver.eigenvalues()[axis])) *
                          solver.eigenvectors().col(axis).transpose();
    }
    return {components, node.replicate(eigen_index(grid.nodes.size()), 1),
            RowMatrix::Zero(points.values.rows(), eigen_index(components))};
}

MovingBasis on_finer_grid(const MovingBasis& basis, const SparseGrid& coarse, const SparseGrid& fine) {
    const Index rows = basis.rows_per_node();
    MovingBasis result{basis.components,
                       RowMatrix::Zero(eigen_index(fine.nodes.size()) * rows, basis.rows.cols()),
                       basis.weights};
    const std::vector<CoarseCorners> corners = corners_in(coarse, fine);
    for (std::size_t n = 0; n < corners.size(); ++n)
        for (std::size_t corner = 0; corner < kCorners; ++corner)
            if (corners[n].share[corner] > 0)
                result.rows.middleRows(eigen_index(n) * rows, rows) +=
                    corners[n].share[corner] * basis.rows.middleRows(corners[n].nodes[corner] * rows, rows);
    return result;
}

MovingBasis truncated(const MovingBasis& basis, std::size_t components) {
    const Index rows = basis.rows_per_node(), kept = eigen_index(components) + 1;
    MovingBasis result{components, RowMatrix(basis.rows.rows() / rows * kept, basis.rows.cols()),
                       basis.weights.leftCols(eigen_index(components))};
    for (Index n = 0; n < basis.rows.rows() / rows; ++n)
        result.rows.middleRows(n * kept, kept) = basis.rows.middleRows(n * rows, kept);
    return result;
}

void normalise(const GridPoints& points, const SparseGrid& grid, MovingBasis& basis) {
    const Index components = eigen_index(basis.components);
    if (components == 0)
        return;
    const Spread weights = spread_of(points, basis.weights);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> whole(weights.covariance);
    const float least = 1e-10f * whole.eigenvalues().maxCoeff(); // float rounding, squared, is 1e-14
    Eigen::MatrixXf to = whole.eigenvectors(), from = whole.eigenvectors();
    for (Index l = 0; l < components; ++l) {
        const float variance = whole.eigenvalues()[l], deviation = std::sqrt(std::max(0.0f, variance));
        to.col(l) *= variance > least ? 1 / deviation : 0;
        from.col(l) *= variance > least ? deviation : 0;
    }
    change_weights(basis, weights.mean, to, from);
    Eigen::MatrixXf outer = Eigen::MatrixXf::Zero(components, components);
    for_rows(grid, basis, [&](std::size_t i, const RowMatrix& rows) {
        outer += points.significance[grid.receivers[i]] * rows.bottomRows(components) *
                 rows.bottomRows(components).transpose();
    });
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> carried(outer);
    const Eigen::MatrixXf rotation = carried.eigenvectors().rowwise().reverse();
    change_weights(basis, Eigen::VectorXf::Zero(components), rotation, rotation);
}

} // namespace prt
