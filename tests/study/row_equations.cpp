// Rows of a moving basis for given weights: sparse least squares by conjugate gradients.

#include "row_equations.h"

#include "runtime/core/support/parallel.h"

#include <Eigen/Dense>

#include <algorithm>

namespace prt {
namespace {

using Index = Eigen::Index;

constexpr std::size_t kCellGrain = 8;

Eigen::RowVectorXf products(const RowMatrix& a, const RowMatrix& b) {
    return a.cwiseProduct(b).colwise().sum();
}

/// Returns the ratios, and 0 for a zero denominator.
Eigen::RowVectorXf ratios(const Eigen::RowVectorXf& a, const Eigen::RowVectorXf& b) {
    return (b.array() > 0).select(a.array() / b.array(), 0.0f);
}

bool make_an_edge(const glm::ivec3& a, const glm::ivec3& b) {
    const glm::ivec3 d = a - b;
    return d.x * d.x + d.y * d.y + d.z * d.z == 1;
}

} // namespace

RowEquations::RowEquations(const GridPoints& points, const SparseGrid& grid, const MovingBasis& basis,
                           const RowMultipliers& multipliers)
    : points_(points), grid_(grid), basis_(basis), rows_(basis.rows_per_node()),
      smoothness_(multipliers.smoothness / static_cast<float>(std::max<std::size_t>(1, grid.nodes.size()))),
      ridge_(multipliers.ridge), parts_(grid.nodes.size()), partners_(grid.nodes.size()),
      reach_(grid.nodes.size()) {
    for (std::size_t c = 0; c < grid.cells.size(); ++c)
        for (std::size_t corner = 0; corner < kCorners; ++corner)
            parts_[grid.cells[c].nodes[corner]].push_back(c * kCorners + corner);
    find_partners();
    invert_blocks();
}

void RowEquations::find_partners() {
    for (const SparseGrid::Cell& cell : grid_.cells)
        for (std::size_t corner = 0; corner < kCorners; ++corner)
            for (const std::size_t axis : {1u, 2u, 4u}) {
                // An unused corner has the index of a second one.
                const std::uint32_t a = cell.nodes[corner], b = cell.nodes[corner ^ axis];
                if (make_an_edge(grid_.nodes[a], grid_.nodes[b]))
                    partners_[a].push_back(b);
            }
    for (std::vector<std::size_t>& partners : partners_) {
        std::sort(partners.begin(), partners.end());
        partners.erase(std::unique(partners.begin(), partners.end()), partners.end());
    }
}

void RowEquations::invert_blocks() {
    std::vector<Eigen::MatrixXf> blocks(parts_.size(), Eigen::MatrixXf::Zero(rows_, rows_));
    Eigen::VectorXf row(rows_);
    for (const SparseGrid::Cell& cell : grid_.cells)
        for (std::size_t i = cell.begin; i < cell.end; ++i) {
            row << 1, basis_.weights.row(grid_.receivers[i]).transpose();
            const float a = points_.significance[grid_.receivers[i]];
            const Eigen::MatrixXf outer = a * row * row.transpose();
            for (std::size_t corner = 0; corner < kCorners; ++corner) {
                const float share = grid_.share[i][corner];
                if (share > 0) {
                    blocks[cell.nodes[corner]] += share * share * outer;
                    reach_[cell.nodes[corner]] += share * a;
                }
            }
        }
    for (std::size_t n = 0; n < blocks.size(); ++n) {
        // 1e-7: below float rounding, for nodes with no data or too few.
        blocks[n].diagonal().array() +=
            smoothness_ * static_cast<float>(partners_[n].size()) + 1e-7f * blocks[n].trace() + 1e-30f;
        blocks[n].diagonal().tail(rows_ - 1).array() += ridge_ * reach_[n];
        inverses_.push_back(blocks[n].ldlt().solve(Eigen::MatrixXf::Identity(rows_, rows_)));
    }
}

/// [points of the cell][corners][rows of a node]
RowMatrix RowEquations::shares_of(const SparseGrid::Cell& cell) const {
    RowMatrix shares(eigen_index(cell.end - cell.begin), eigen_index(kCorners) * rows_);
    for (std::size_t i = cell.begin; i < cell.end; ++i)
        for (std::size_t corner = 0; corner < kCorners; ++corner) {
            auto to = shares.row(eigen_index(i - cell.begin)).segment(eigen_index(corner) * rows_, rows_);
            to[0] = grid_.share[i][corner];
            to.tail(rows_ - 1) = grid_.share[i][corner] * basis_.weights.row(grid_.receivers[i]);
        }
    return shares;
}

/// Sums `per_point(cell, shares)`, [points of the cell][dimension], by share and significance into rows.
template <class PerPoint>
RowMatrix RowEquations::gathered(PerPoint&& per_point) const {
    const Index of_cell = eigen_index(kCorners) * rows_, columns = points_.values.cols();
    RowMatrix parts(eigen_index(grid_.cells.size()) * of_cell, columns);
    parallel_for(grid_.cells.size(), kCellGrain, points_.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            const SparseGrid::Cell& cell = grid_.cells[c];
            const RowMatrix shares = shares_of(cell);
            RowMatrix values = per_point(cell, shares);
            for (std::size_t i = cell.begin; i < cell.end; ++i)
                values.row(eigen_index(i - cell.begin)) *= points_.significance[grid_.receivers[i]];
            parts.middleRows(eigen_index(c) * of_cell, of_cell).noalias() = shares.transpose() * values;
        }
    });
    RowMatrix result = RowMatrix::Zero(eigen_index(parts_.size()) * rows_, columns);
    for (std::size_t n = 0; n < parts_.size(); ++n)
        for (const std::size_t part : parts_[n])
            result.middleRows(eigen_index(n) * rows_, rows_) +=
                parts.middleRows(eigen_index(part) * rows_, rows_);
    return result;
}

RowMatrix RowEquations::apply(const RowMatrix& rows) const {
    RowMatrix result = gathered([&](const SparseGrid::Cell& cell, const RowMatrix& shares) -> RowMatrix {
        RowMatrix of_cell(eigen_index(kCorners) * rows_, rows.cols());
        for (std::size_t corner = 0; corner < kCorners; ++corner)
            of_cell.middleRows(eigen_index(corner) * rows_, rows_) =
                rows.middleRows(cell.nodes[corner] * rows_, rows_);
        return shares * of_cell;
    });
    for (std::size_t n = 0; n < partners_.size(); ++n) {
        const auto own = rows.middleRows(eigen_index(n) * rows_, rows_);
        auto to = result.middleRows(eigen_index(n) * rows_, rows_);
        to.bottomRows(rows_ - 1) += ridge_ * reach_[n] * own.bottomRows(rows_ - 1);
        for (const std::size_t m : partners_[n])
            to += smoothness_ * (own - rows.middleRows(eigen_index(m) * rows_, rows_));
    }
    return result;
}

RowMatrix RowEquations::right_side() const {
    return gathered([&](const SparseGrid::Cell& cell, const RowMatrix&) {
        RowMatrix values(eigen_index(cell.end - cell.begin), points_.values.cols());
        for (std::size_t i = cell.begin; i < cell.end; ++i)
            values.row(eigen_index(i - cell.begin)) = points_.values.row(grid_.receivers[i]);
        return values;
    });
}

RowMatrix RowEquations::preconditioned(const RowMatrix& residual) const {
    RowMatrix result(residual.rows(), residual.cols());
    for (std::size_t n = 0; n < inverses_.size(); ++n)
        result.middleRows(eigen_index(n) * rows_, rows_) =
            inverses_[n] * residual.middleRows(eigen_index(n) * rows_, rows_);
    return result;
}

void improve_rows(const GridPoints& points, const SparseGrid& grid, MovingBasis& basis,
                  const RowMultipliers& multipliers, int steps) {
    const RowEquations equations(points, grid, basis, multipliers);
    RowMatrix residual = equations.right_side() - equations.apply(basis.rows);
    RowMatrix z = equations.preconditioned(residual), direction = z;
    Eigen::RowVectorXf product = products(residual, z);
    for (int step = 0; step < steps; ++step) {
        const RowMatrix image = equations.apply(direction);
        const Eigen::RowVectorXf length = ratios(product, products(direction, image));
        basis.rows += direction * length.asDiagonal();
        residual -= image * length.asDiagonal();
        z = equations.preconditioned(residual);
        const Eigen::RowVectorXf next = products(residual, z);
        direction = (z + direction * ratios(next, product).asDiagonal()).eval();
        product = next;
    }
}

} // namespace prt
