#pragma once

#include "moving_basis.h"

#include <vector>

namespace prt {

/// Costs of rows in addition to the error.
struct RowMultipliers {
    float smoothness = 0; ///< for differences between nodes of one edge, all nodes together
    float ridge = 0;      ///< for the squared length of bases, at receivers
};

/// Matrix-free normal equations of all rows of a grid for given weights. Sums have a fixed order, independent
/// of the number of threads.
class RowEquations {
public:
    /// Keeps references.
    RowEquations(const GridPoints& points, const SparseGrid& grid, const MovingBasis& basis,
                 const RowMultipliers& multipliers);

    /// Applies the matrix of the equations to `rows`.
    RowMatrix apply(const RowMatrix& rows) const;
    RowMatrix right_side() const;
    /// Solves the diagonal block of each node.
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
    Eigen::Index rows_; ///< rows per node
    float smoothness_, ridge_;
    std::vector<std::vector<std::size_t>> parts_;    ///< [nodes]: cells · kCorners + corner
    std::vector<std::vector<std::size_t>> partners_; ///< [nodes]: at the other ends of edges of cells
    std::vector<float> reach_;                       ///< [nodes]: significance, by share
    std::vector<Eigen::MatrixXf> inverses_;          ///< [nodes]
};

/// Takes `steps` of conjugate gradients (Hestenes and Stiefel 1952), separately for each column of the rows,
/// starting from the rows of `basis`.
void improve_rows(const GridPoints& points, const SparseGrid& grid, MovingBasis& basis,
                  const RowMultipliers& multipliers, int steps);

} // namespace prt
