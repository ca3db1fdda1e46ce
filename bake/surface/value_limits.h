#pragma once

// Bounds of fitted values: the values of the samples around each vertex (a limiter, as in flux-limited
// transport).

#include "surface/fit_equations.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Test values of a vector, which are linear in it, and must not leave the range that they have at samples.
/// Values of one group are limited by one factor.
class TestValues {
public:
    /// For transfer [channels][order²]: exit radiance under uniform light of radiance 1 and under six broad
    /// directional lights of at most 1. One group.
    static TestValues of_sky(int order, int channels);
    /// For light of lamps [channels][stride]: each number. One group for each lamp.
    static TestValues of_lamps(std::size_t lamps, int channels, std::size_t stride);

    std::size_t count() const { return tests_.size(); }
    std::size_t groups() const { return groups_; }
    std::size_t group_of_test(std::size_t test) const { return tests_[test].group; }
    /// kNoReceiver: no light.
    std::uint32_t group_of_column(std::size_t column) const { return group_of_column_[column]; }
    /// The value may not leave the range at all; others may by a share of it, as values at vertices do where
    /// the surface is curved.
    bool exact(std::size_t test) const { return tests_[test].exact; }
    /// Upper bound unless samples exceed it: 1 under uniform light.
    float bound(std::size_t test) const { return tests_[test].bound; }
    /// Writes [count]. Of a sky of one channel `vector` may end after `first_coefficients`.
    void evaluate(std::span<const float> vector, std::span<float> values) const;

private:
    struct Test {
        std::size_t first; ///< column
        std::vector<float> weights;
        std::size_t group;
        bool exact;
        float bound;
    };
    std::vector<Test> tests_;
    std::vector<std::uint32_t> group_of_column_;
    std::size_t groups_ = 1;
};

/// Light at the samples of a fit, as far as the fit needs it.
struct SampledLight {
    std::size_t stride = 0;    ///< numbers of a vector
    std::size_t tests = 0;     ///< test values of a sample
    std::vector<float> sums;   ///< [unknowns][stride] Σ_s a_s φ_i(s) T(s)
    std::vector<float> sharp;  ///< [unknowns][stride] the solution for `sums`; empty: not solved yet
    std::vector<float> values; ///< [samples][tests]
};

/// The values of the samples around each unknown.
struct ValueRanges {
    std::vector<float> low, high; ///< [unknowns][tests]; low > high where no sample tells
};
/// `values` [samples][tests].
ValueRanges value_ranges(const FitEquations& equations, std::span<const float> values, std::size_t tests);

/// How much of `sharp` an unknown may take beside 1 - θ of `smooth`: lowers θ [unknowns][groups] until the
/// test values lie within `ranges`. Both are [unknowns][columns of `tests`].
void limit_shares(const TestValues& tests, const ValueRanges& ranges, std::span<const float> smooth,
                  std::span<const float> sharp, std::span<float> shares);

} // namespace prt
