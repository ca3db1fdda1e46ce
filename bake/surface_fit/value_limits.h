#pragma once

// Bounds of fitted values: the values of the samples around each vertex (a limiter, as in flux-limited
// transport).

#include "bake/surface_fit/fit_equations.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Test values of a vector. They are linear in the vector, and must stay within their range at the samples.
/// Values of one group are limited by one factor.
class TestValues {
public:
    /// Tests for transfer [channels][order²]: exit radiance under uniform light of radiance 1 and under six
    /// broad directional lights of at most 1. One group.
    static TestValues of_sky(int order, int channels);
    /// Tests for light of lamps [channels][stride]: each number. One group per lamp.
    static TestValues of_lamps(std::size_t lamps, int channels, std::size_t stride);

    std::size_t count() const { return tests_.size(); }
    std::size_t groups() const { return groups_; }
    std::size_t group_of_test(std::size_t test) const { return tests_[test].group; }
    /// Group that limits a column; kNoReceiver: the column has no light.
    std::uint32_t group_of_column(std::size_t column) const { return group_of_column_[column]; }
    /// Whether the value must not leave the range at all; other values may exceed it by a share of it, as
    /// values at vertices do on curved surfaces.
    bool exact(std::size_t test) const { return tests_[test].exact; }
    /// Upper bound unless samples exceed it: 1 under uniform light.
    float bound(std::size_t test) const { return tests_[test].bound; }
    /// Writes the test values [count]. For a sky with one channel `vector` may end after
    /// `first_coefficients`.
    void evaluate(std::span<const float> vector, std::span<float> values) const;

private:
    struct Test {
        std::size_t first; ///< first column
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
    std::size_t stride = 0;    ///< length of a vector
    std::size_t tests = 0;     ///< number of test values per sample
    std::vector<float> sums;   ///< [unknowns][stride] Σ_s a_s φ_i(s) T(s)
    std::vector<float> sharp;  ///< [unknowns][stride] solution for `sums`; empty: not solved yet
    std::vector<float> values; ///< [samples][tests]
};

/// Range of the samples around each unknown.
struct ValueRanges {
    std::vector<float> low, high; ///< [unknowns][tests]; low > high if there is no sample
};
/// Computes the ranges from `values` [samples][tests].
ValueRanges value_ranges(const FitEquations& equations, std::span<const float> values, std::size_t tests);

/// Lowers the share θ of `sharp`, mixed with 1 - θ of `smooth`, [unknowns][groups], until the test values are
/// within `ranges`. Both are [unknowns][columns of `tests`].
void limit_shares(const TestValues& tests, const ValueRanges& ranges, std::span<const float> smooth,
                  std::span<const float> sharp, std::span<float> shares);

} // namespace prt
