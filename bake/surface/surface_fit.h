#pragma once

#include "surface/fit_solver.h"
#include "surface/value_limits.h"

#include <optional>

namespace prt {

/// Divides sums over samples [unknowns][stride] by `weights` [unknowns]; zero where there are none.
template <class Value>
void smooth(std::span<const float> weights, std::span<Value> sums_then_values, std::size_t stride) {
    for (std::size_t u = 0; u < weights.size(); ++u)
        for (std::size_t c = 0; c < stride; ++c) {
            Value& v = sums_then_values[u * stride + c];
            v = weights[u] > 0 ? v / static_cast<Value>(weights[u]) : Value(0);
        }
}

/// Samples of the surface, and the operators from light at them to light at receivers (section 14 of
/// docs/math.md). The smooth one takes the mean of the samples around each vertex: it adds no light, so that
/// bounces use it. The sharp one is nearest to the samples over the surface, and is for values that are
/// written.
struct SurfaceFit {
    SurfaceSamples samples;
    FitEquations equations;
    std::vector<float> weights;     ///< [unknowns] of all samples
    FitSolver sky;                  ///< of distant light
    std::optional<FitSolver> lamps; ///< of light of lamps without a bounce, where there are lamps

    /// Smooth values [unknowns][stride] from sums over samples.
    template <class Value>
    void smooth(std::span<Value> sums_then_values, std::size_t stride) const {
        prt::smooth(weights, sums_then_values, stride);
    }
};

/// Light without a bounce and the rest of it, [unknowns][stride] each.
struct SharpLight {
    std::vector<float> direct, rest;
};

/// Sharp values, limited so that direct light, the rest and their sum stay within the values of the samples.
/// `rest` may be null; its channels are those of `direct`, or any number where `direct` has one.
class SharpFit {
public:
    /// One solver keeps the sum of both parts what it is.
    SharpFit(const SurfaceFit& fit, const FitSolver& of_direct, const FitSolver& of_rest, int threads)
        : fit_(fit), of_direct_(of_direct), of_rest_(of_rest), threads_(threads) {}
    SharpLight solve(const TestValues& of_direct, const SampledLight& direct, const TestValues* of_rest,
                     const SampledLight* rest) const;

private:
    struct Values {
        std::vector<float> smooth, sharp; ///< [unknowns][stride]
    };
    Values values_of(const SampledLight& light, const FitSolver& solver) const;
    void mix(const TestValues& tests, std::span<const float> shares, Values& values) const;

    const SurfaceFit& fit_;
    const FitSolver &of_direct_, &of_rest_;
    int threads_;
};

} // namespace prt
