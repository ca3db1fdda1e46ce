#pragma once

#include "moving_basis.h"

#include <vector>

namespace prt {

/// What rows cost beside the error.
struct RowPrices {
    float smoothness = 0; ///< of differences between nodes of one edge, all nodes together
    float ridge = 0;      ///< of the squared length of bases, where receivers are
};

/// Equations of the least error of all rows of a grid, the weights given, without a matrix. Sums have one
/// order, whatever the number of threads.
class RowEquations {
public:
    /// Keeps references.
    RowEquations(const GridPoints& points, const SparseGrid& grid, const MovingBasis& basis,
                 const RowPrices& prices);

    /// What the equations make of `rows`.
    RowMatrix apply(const RowMatrix& rows) const;
    RowMatrix right_side() const;
    /// Solves what is each node's own.
    RowMatrix preconditioned(const RowMatrix& residual) const;

private:
    void find_partners();
    void invert_blocks();
    RowMatrix shares_of(const SparseGrid::Cell& cell) const;
    template <class PerPoint>
    RowMatrix gathered(PerPoint&& per_point) const;

    const GridPoints& points_;
    const SparseGrid& grid_;
    const MovingBasis& basis_;
    Eigen::Index rows_; ///< of a node
    float smoothness_, ridge_;
    std::vector<std::vector<std::size_t>> parts_;    ///< [nodes]: cells · kCorners + corner
    std::vector<std::vector<std::size_t>> partners_; ///< [nodes]: at the other ends of edges of cells
    std::vector<float> reach_;                       ///< [nodes]: significance, by share
    std::vector<Eigen::MatrixXf> inverses_;          ///< [nodes]
};

/// Takes `steps` of conjugate gradients (Hestenes and Stiefel 1952), each number of the rows for itself,
/// from the rows of `basis` on.
void improve_rows(const GridPoints& points, const SparseGrid& grid, MovingBasis& basis,
                  const RowPrices& prices, int steps);

} // namespace prt
