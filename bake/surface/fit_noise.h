#pragma once

// Fits that bend as far as light does and its noise does not (docs/math.md, section 14).

#include "surface/fit_solver.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Some columns of many, and factors on their values.
struct TellingColumns {
    std::vector<std::size_t> columns;
    std::vector<float> factors;

    std::size_t size() const { return columns.size(); }
};
/// TellingColumns that stand for all of a sky, one block of the solver: of the first two bands all, since
/// they hold the light of curved surfaces. Factors: so that sums of squares are those of all.
TellingColumns columns_of_sky(std::size_t stride);
/// Those with the largest mean `squares`, one block of the solver, each over its root mean square: so do
/// lamps count alike.
TellingColumns brightest_columns(std::span<const double> squares);

/// +1 or -1 for each group of samples that share the rays of one receiver.
float sign_of_group(std::size_t group, std::uint64_t seed);

/// Sums over samples, plainly and with the signs of groups, [unknowns][columns].
struct NoisySums {
    std::size_t columns = 0;
    std::vector<float> plain, with_signs;
};

struct NoiseSolver {
    FitSolver solver;
    std::vector<float> residuals; ///< with signs, of a first fit, [unknowns][columns]: sums of noise alone
};
/// Solves with the bend weights that the noise in `sums` asks for.
NoiseSolver noise_solver(const SurfaceSamples& samples, const FitEquations& equations, NoisySums sums,
                         std::uint64_t seed, int threads);
/// The same for light of lamps, whose `values` at samples are [samples][columns].
FitSolver lamp_solver(const SurfaceSamples& samples, const FitEquations& equations,
                      std::span<const float> values, std::size_t columns, std::uint64_t seed, int threads);

} // namespace prt
