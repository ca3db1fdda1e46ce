#pragma once

// Removes the noise of rays from light.

#include "bake/plan/plan.h"
#include "bake/scene/shared_positions.h"
#include "bake/surface_fit/fit_noise.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

/// Replaces light at positions of a surface by light with smaller second differences where second differences
/// are noise. It uses the equations of a surface fit with one sample at an unknown for each position
/// (docs/math.md, section 14). The filter is linear, and its rows sum to 1.
class NoiseFilter {
public:
    /// `positions` [samples of `equations`]: indices that values are requested by; FitEquations::unknown_of
    /// uses the same indices.
    NoiseFilter(FitEquations equations, std::vector<std::uint32_t> positions, int threads);

    using Values = std::function<float(std::uint32_t position, std::size_t column)>;
    using Write = std::function<void(std::uint32_t position, std::size_t column, float value)>;

    /// Chooses smoothness weights for all columns of `light` from some of them. `noise`: an estimate of the
    /// noise with random sign.
    FitSolver fit(const Values& light, const RepresentativeColumns& columns, const Values& noise) const;
    /// Root of the sum of squares over the surface of some columns after filtering.
    double norm(const FitSolver& solver, const RepresentativeColumns& columns, const Values& values) const;
    /// Returns the brightest columns of `light`.
    RepresentativeColumns brightest(const Values& light, std::size_t columns) const;

    /// Filters all columns. A filtered value stays within the range of the original value and of the values
    /// that share a second difference with it; exact zeros are kept. Columns are read in blocks before they
    /// are written. `write` is called from several threads.
    void apply(const FitSolver& solver, std::size_t columns, const Values& light, const Write& write) const;
    /// Filters all columns of a transfer.
    void apply(const FitSolver& solver, Transfer& light) const;

private:
    /// Sums over samples, [unknowns][columns].
    std::vector<float> sums(const RepresentativeColumns& columns, const Values& values) const;
    void apply_to(const FitSolver& solver, const RepresentativeColumns& columns, const Values& light,
                  const Write& write) const;
    /// Limits x [unknowns][columns] to the range of `means` at each unknown and at those that share a second
    /// difference with it.
    void limit(std::span<const float> means, std::size_t columns, std::span<float> x) const;

    FitEquations equations_;
    std::vector<std::uint32_t> positions_; ///< [samples]
    std::vector<float> weights_;           ///< [unknowns]
    int threads_;
};

/// Creates a filter for the receivers of `plan`. Receivers that `shared` averages share one unknown.
/// `left_out` [receivers]: receivers whose light is not gathered by their own rays.
NoiseFilter vertex_filter(const BakePlan& plan, const SharedPositions& shared,
                          const std::vector<bool>& left_out);

} // namespace prt
