#pragma once

// Operators from light at samples of the surface to light at receivers.

#include "bake/surface_fit/fit_solver.h"
#include "bake/surface_fit/value_limits.h"

#include <optional>

namespace prt {

/// Divides sums over samples [unknowns][stride] by `weights` [unknowns]; zero for a zero weight.
template <class Value>
void smooth(std::span<const float> weights, std::span<Value> sums_then_values, std::size_t stride) {
    for (std::size_t u = 0; u < weights.size(); ++u)
        for (std::size_t c = 0; c < stride; ++c) {
            Value& v = sums_then_values[u * stride + c];
            v = weights[u] > 0 ? v / static_cast<Value>(weights[u]) : Value(0);
        }
}

/// Samples of the surface, and the operators from light at samples to light at receivers (section 14 of
/// docs/math.md). The smooth operator computes the mean of the samples around each vertex: it adds no light,
/// so bounces use it. The sharp operator minimises the error at the samples, and is for values that are
/// written.
struct SurfaceFit {
    SurfaceSamples samples;
    FitEquations equations;
    std::vector<float> weights;     ///< [unknowns] total weight of the samples
    FitSolver sky;                  ///< solver for distant light
    std::optional<FitSolver> lamps; ///< solver for light of lamps without a bounce, if there are lamps

    /// Converts sums over samples to smooth values [unknowns][stride].
    template <class Value>
    void smooth(std::span<Value> sums_then_values, std::size_t stride) const {
        prt::smooth(weights, sums_then_values, stride);
    }
};

/// Light without a bounce and bounced light, [unknowns][stride] each.
struct SharpLight {
    std::vector<float> direct, rest;
};

/// Computes sharp values, limited so that direct light, bounced light and their sum stay within the values of
/// the samples. `rest` may be null; it has the channels of `direct`, or any number of channels if `direct`
/// has one.
class SharpFit {
public:
    /// If both solvers are the same, the sum of both parts is preserved.
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
