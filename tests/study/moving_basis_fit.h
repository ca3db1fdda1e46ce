#pragma once

#include "moving_basis_tuning.h"
#include "row_equations.h"

namespace prt {

struct MovingBasisFit {
    SparseGrid grid;
    MovingBasis basis;
};

struct MovingBasisSchedule {
    RowPrices prices = {tuning::kSmoothness, tuning::kRowRidge};
    double weight_price = tuning::kWeightPrice; ///< of a squared weight, as a share of the squared error
    int rounds = tuning::kRoundsOfGrid;
};

/// The least squared error with cells of `size`, by alternating least squares, from principal components of
/// all points on, which are those of the one cell of the first grid, on ever finer grids. Normalised.
MovingBasisFit fit_moving_basis(const GridPoints& points, double size, std::size_t components,
                                const MovingBasisSchedule& schedule = {});

/// The best weights, the rows given, where a squared weight costs `price`.
void solve_weights(const GridPoints& points, const SparseGrid& grid, MovingBasis& basis, float price = 0);

/// How much each product of two rows, and of each row with what the mean leaves, counts for the weights of
/// the receiver at place `i` of grid.receivers.
struct WeightEquations {
    Eigen::MatrixXf gram;  ///< [components][components]
    Eigen::VectorXf right; ///< [components]
};
WeightEquations weight_equations(const GridPoints& points, const SparseGrid& grid, const MovingBasis& basis,
                                 const SparseGrid::Cell& cell, std::size_t i, float price);

} // namespace prt
