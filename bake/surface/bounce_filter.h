#pragma once

// Bounced light without the noise of its rays.

#include "plan.h"
#include "scene/shared_places.h"
#include "surface/fit_noise.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Replaces bounced light of receivers by light that bends less where bends are noise: the equations of a
/// surface fit whose samples are the receivers (docs/math.md, section 14). A second gather operator of half
/// of the rays tells noise: what it gathers differs from bounced light by half of the difference between two
/// halves.
class BounceFilter {
public:
    /// Receivers that `shared` takes means of are one unknown. `left_out` [receivers]: those whose light is
    /// not what their own rays gathered.
    BounceFilter(const BakePlan& plan, const SharedPlaces& shared, const std::vector<bool>& left_out);

    /// Filters what `light` has more than `unbounced`, [receivers][channels][columns] both, the latter of as
    /// many channels or one. `half` [receivers][channels][columns]: the same as half of the rays gather it.
    void apply(Transfer& light, const Transfer& unbounced, std::span<const float> half) const;

private:
    struct Light {
        const Transfer &all, &unbounced;
        std::span<const float> half;
    };
    TellingColumns telling(const Light& light) const;
    /// Sums over samples [unknowns][columns] of `value(receiver, column)`.
    template <class Value>
    std::vector<float> sums(const TellingColumns& columns, Value&& value) const;
    FitSolver solver(const Light& light) const;
    /// Limits x [unknowns][columns] to the range of `means` over each unknown and those that it bends with.
    void limit(std::span<const float> means, std::size_t columns, std::span<float> x) const;

    const BakePlan& plan_;
    std::vector<std::uint32_t> receivers_; ///< [samples]
    FitEquations equations_;
    std::vector<float> weights_; ///< [unknowns]
};

} // namespace prt
