#pragma once

// Light without the noise of its rays.

#include "plan.h"
#include "scene/shared_places.h"
#include "surface/fit_noise.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

/// Replaces light at places of a surface by light that bends less where bends are noise: the equations of a
/// surface fit with a sample for each place, at an unknown (docs/math.md, section 14). It is linear, and its
/// rows sum to 1.
class NoiseFilter {
public:
    /// `places` [samples of `equations`]: by what values are asked for; FitEquations::unknown_of is of them.
    NoiseFilter(FitEquations equations, std::vector<std::uint32_t> places, int threads);

    using Values = std::function<float(std::uint32_t place, std::size_t column)>;
    using Write = std::function<void(std::uint32_t place, std::size_t column, float value)>;

    /// Bends that serve all columns of `light`, by some. `noise`: what is likely to be noise, of random sign.
    FitSolver fit(const Values& light, const TellingColumns& columns, const Values& noise) const;
    /// Root of the sum of squares over the surface of some columns, filtered.
    double norm(const FitSolver& solver, const TellingColumns& columns, const Values& values) const;
    /// The brightest of the columns of `light`.
    TellingColumns brightest(const Values& light, std::size_t columns) const;

    /// Filters all columns. A value stays within the range of its own and of those that it bends with; exact
    /// zeros stay. Reads some columns before it writes them. `write` is called from several threads.
    void apply(const FitSolver& solver, std::size_t columns, const Values& light, const Write& write) const;
    /// The same of a transfer of all places.
    void apply(const FitSolver& solver, Transfer& light) const;

private:
    /// Sums over samples [unknowns][columns].
    std::vector<float> sums(const TellingColumns& columns, const Values& values) const;
    void apply_to(const FitSolver& solver, const TellingColumns& columns, const Values& light,
                  const Write& write) const;
    /// Limits x [unknowns][columns] to the range of `means` over each unknown and those that it bends with.
    void limit(std::span<const float> means, std::size_t columns, std::span<float> x) const;

    FitEquations equations_;
    std::vector<std::uint32_t> places_; ///< [samples]
    std::vector<float> weights_;        ///< [unknowns]
    int threads_;
};

/// Of the receivers of `plan`. Those that `shared` takes means of are one unknown. `left_out` [receivers]:
/// those whose light is not what their own rays gathered.
NoiseFilter vertex_filter(const BakePlan& plan, const SharedPlaces& shared,
                          const std::vector<bool>& left_out);

} // namespace prt
