// Fits a moving basis by alternating least squares (Silvennoinen and Sloan 2021, "Moving Basis Decomposition
// for Precomputed Light Transport"): docs/math.md, section 4.

#include "moving_basis_fit.h"

#include "runtime/core/support/parallel.h"

#include <Eigen/Dense>

namespace prt {
namespace {

/// Optimises rows and weights in alternation. Rows are extrapolated (Nesterov 1983) until this increases the
/// error, which needs a fifth of the rounds.
void alternate(const GridPoints& points, MovingBasisFit& fit, const MovingBasisSchedule& schedule,
               int rounds) {
    MovingBasis& basis = fit.basis;
    RowMatrix relighter;
    double relighter_error = squared_error(points, values_of(points, fit.grid, basis));
    int carried = 0; // rounds
    for (int round = 0; round < rounds; ++round) {
        if (round % tuning::kRoundsBetweenNorms == 0) {
            normalise(points, fit.grid, basis);
            carried = 0;
        }
        improve_rows(points, fit.grid, basis, schedule.multipliers, tuning::kRowSteps);
        const RowMatrix rows = basis.rows;
        if (carried > 0)
            basis.rows += static_cast<float>(carried) / static_cast<float>(carried + 3) * (rows - relighter);
        relighter = rows;
        solve_weights(points, fit.grid, basis,
                      static_cast<float>(schedule.weight_multiplier * relighter_error));
        const double error = squared_error(points, values_of(points, fit.grid, basis));
        carried = carried > 0 && error > relighter_error ? 0 : carried + 1;
        relighter_error = error;
    }
}

} // namespace

WeightEquations weight_equations(const GridPoints& points, const SparseGrid& grid, const MovingBasis& basis,
                                 const SparseGrid::Cell& cell, std::size_t i, float multiplier) {
    RowMatrix rows;
    interpolate(grid, basis, cell, i, rows);
    const auto b = rows.bottomRows(basis.rows_per_node() - 1);
    WeightEquations equations{b * b.transpose(),
                              b * (points.values.row(grid.receivers[i]) - rows.row(0)).transpose()};
    equations.gram.diagonal().array() += tuning::kWeightRidge * equations.gram.trace() + multiplier + 1e-30f;
    return equations;
}

void solve_weights(const GridPoints& points, const SparseGrid& grid, MovingBasis& basis, float multiplier) {
    if (basis.components == 0)
        return;
    parallel_for(grid.cells.size(), 8, points.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c)
            for (std::size_t i = grid.cells[c].begin; i < grid.cells[c].end; ++i) {
                const WeightEquations equations =
                    weight_equations(points, grid, basis, grid.cells[c], i, multiplier);
                basis.weights.row(grid.receivers[i]) =
                    equations.gram.ldlt().solve(equations.right).transpose();
            }
    });
}

MovingBasisFit fit_moving_basis(const GridPoints& points, double size, std::size_t components,
                                const MovingBasisSchedule& schedule) {
    double coarsest = size;
    while (coarsest < longest_edge(points.positions))
        coarsest *= 2;
    MovingBasisFit fit{sparse_grid(points.positions, coarsest), {}};
    fit.basis = principal_components(points, fit.grid, components);
    solve_weights(points, fit.grid, fit.basis);
    while (fit.grid.size > size) {
        alternate(points, fit, schedule, tuning::kRoundsOfCoarseGrid);
        SparseGrid finer = sparse_grid(points.positions, fit.grid.size / 2);
        fit.basis = on_finer_grid(fit.basis, fit.grid, finer);
        fit.grid = std::move(finer);
        solve_weights(points, fit.grid, fit.basis);
    }
    alternate(points, fit, schedule, schedule.rounds);
    normalise(points, fit.grid, fit.basis);
    return fit;
}

} // namespace prt
