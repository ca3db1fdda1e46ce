#pragma once

#include "moving_basis_tuning.h"
#include "row_equations.h"

namespace prt {

struct MovingBasisFit {
    SparseGrid grid;
    MovingBasis basis;
};

struct MovingBasisSchedule {
    RowMultipliers multipliers = {tuning::kSmoothness, tuning::kRowRidge};
    double weight_multiplier = tuning::kWeightMultiplier; ///< cost of a squared weight, as a fraction of the
                                                          ///< squared error
    int rounds = tuning::kRoundsOfGrid;
};

/// Returns the fit with minimum squared error for cells of `size`, by alternating least squares on
/// successively finer grids. It starts from the principal components of all points, on a first grid with one
/// cell. Normalised.
MovingBasisFit fit_moving_basis(const GridPoints& points, double size, std::size_t components,
                                const MovingBasisSchedule& schedule = {});

/// Computes the best weights for the given rows; a squared weight costs `multiplier`.
void solve_weights(const GridPoints& points, const SparseGrid& grid, MovingBasis& basis,
                   float multiplier = 0);

/// Coefficients of the products of two rows, and of each row with the residual after the mean, in the
/// equations of the weights of the receiver at index `i` of grid.receivers.
struct WeightEquations {
    Eigen::MatrixXf gram;  ///< [components][components]
    Eigen::VectorXf right; ///< [components]
};
WeightEquations weight_equations(const GridPoints& points, const SparseGrid& grid, const MovingBasis& basis,
                                 const SparseGrid::Cell& cell, std::size_t i, float multiplier);

} // namespace prt
