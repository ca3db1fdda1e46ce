#pragma once

// Fits that follow the curvature of light but not its noise (docs/math.md, section 14).

#include "bake/surface_fit/fit_solver.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Selected columns that represent all columns, with factors on their values.
struct RepresentativeColumns {
    std::vector<std::size_t> columns;
    std::vector<float> factors;

    std::size_t size() const { return columns.size(); }
};
/// Returns columns that represent all columns of a sky, one block of the solver: all columns of the first two
/// bands, because they hold the light of curved surfaces, and some of the others. The factors preserve the
/// sum of squares of all columns.
RepresentativeColumns columns_of_sky(std::size_t stride);
/// Returns the columns with the largest mean `squares`, one block of the solver, each divided by its root
/// mean square, so that all lamps have the same weight.
RepresentativeColumns brightest_columns(std::span<const double> squares);

/// Returns +1 or -1 for a group of samples that share the rays of one receiver.
float sign_of_group(std::size_t group, std::uint64_t seed);

/// Sums over samples, without and with the signs of groups, [unknowns][columns].
struct NoisySums {
    std::size_t columns = 0;
    std::vector<float> plain, with_signs;
};

struct NoiseSolver {
    FitSolver solver;
    std::vector<float> residuals; ///< [unknowns][columns] residuals of an initial fit with signs: sums of
                                  ///< noise only
};
/// Creates a solver with smoothness weights for the noise in `sums`.
NoiseSolver noise_solver(const SurfaceSamples& samples, const FitEquations& equations, NoisySums sums,
                         std::uint64_t seed, int threads);
/// Creates a solver with smoothness weights for light of lamps, from its `values` at samples
/// [samples][columns].
FitSolver lamp_solver(const SurfaceSamples& samples, const FitEquations& equations,
                      std::span<const float> values, std::size_t columns, std::uint64_t seed, int threads);

} // namespace prt
