#pragma once

// Light at receivers without the noise of its rays.

#include "plan.h"
#include "scene/shared_places.h"
#include "surface/fit_noise.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace prt {

/// Replaces light of receivers by light that bends less where bends are noise: the equations of a surface fit
/// whose samples are the receivers (docs/math.md, section 14). It is linear, and its rows sum to 1.
class NoiseFilter {
public:
    /// Receivers that `shared` takes means of are one unknown. `left_out` [receivers]: those whose light is
    /// not what their own rays gathered. Keeps a reference to `plan`.
    NoiseFilter(const BakePlan& plan, const SharedPlaces& shared, const std::vector<bool>& left_out);

    /// What is likely to be the noise of a receiver in a column of a transfer, of random sign.
    using Noise = std::function<float(std::uint32_t receiver, std::size_t column)>;
    struct Fitted {
        FitSolver solver;
        double noise; ///< relative L2 that is left in the filtered light of the telling columns
    };
    /// Bends that serve all columns, by the noise of some.
    Fitted fit(const Transfer& light, const TellingColumns& columns, const Noise& noise) const;
    /// The brightest columns of `light`.
    TellingColumns brightest(const Transfer& light) const;

    /// Filters `light` of all receivers. A value stays within the range of its own and of those across the
    /// edges of its vertex; exact zeros stay.
    void apply(const FitSolver& solver, Transfer& light) const;

private:
    /// Sums over samples [unknowns][columns] of `value(receiver, column)`.
    template <class Value>
    std::vector<float> sums(const TellingColumns& columns, Value&& value) const;
    /// Sum of squares over the surface of x [unknowns][columns].
    double square(std::span<const float> x, std::size_t columns) const;
    void apply_to(const FitSolver& solver, const TellingColumns& columns, Transfer& light) const;
    /// Limits x [unknowns][columns] to the range of `means` over each unknown and those that it bends with.
    void limit(std::span<const float> means, std::size_t columns, std::span<float> x) const;

    const BakePlan& plan_;
    std::vector<std::uint32_t> receivers_; ///< [samples]
    FitEquations equations_;
    std::vector<float> weights_; ///< [unknowns]
};

} // namespace prt
