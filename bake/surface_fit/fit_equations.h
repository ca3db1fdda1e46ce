#pragma once

// Least-squares fit of vertex values whose interpolation matches samples of the surface (L. Kavan, A. W.
// Bargteil and P.-P. Sloan, "Least Squares Vertex Baking", EGSR 2011; docs/math.md, section 14).

#include "bake/surface_fit/smoothness.h"
#include "bake/surface_fit/surface_samples.h"
#include "bake/trace/vector_sums.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Equation of a sample: Σ shares_i x_i, with the weight `area`.
struct FitRow {
    std::array<std::uint32_t, 3> unknowns; ///< kNoReceiver: no unknown
    std::array<float, 3> shares;
    float area; ///< m²
};

/// The least-squares problem Σ_s a_s (Σ_i φ_i(s) x_i - T_s)². Equivalent receivers share one unknown x_i;
/// receivers on no surface have no unknown and stay dark.
struct FitEquations {
    std::vector<std::uint32_t> unknown_of; ///< [receivers] unknown; kNoReceiver: none
    std::size_t unknowns = 0;
    std::vector<FitRow> rows;                         ///< [samples]
    std::vector<SecondDifference> second_differences; ///< second differences of x
};
/// Creates the equations. `alike` [receivers]: the first receiver that shares an unknown with each.
FitEquations fit_equations(const Surfaces& surfaces, const TransportReceivers& receivers,
                           const SurfaceSamples& samples, std::span<const std::uint32_t> alike);

/// Unknowns of b that a sample is added to, with positive sign.
SumRow sum_row(const FitRow& row);

/// Total weight of the samples at each unknown: [unknowns].
std::vector<float> unknown_weights(const FitEquations& equations);

/// Adds a_s φ_i(s) T_s times `sign` to b [unknowns][stride], for values T of the samples from `first` on,
/// [count][stride].
template <class Value>
void add_samples(const FitEquations& equations, std::size_t first, std::span<const Value> samples,
                 std::size_t stride, std::span<Value> b, float sign = 1) {
    for (std::size_t s = 0; s * stride < samples.size(); ++s) {
        const FitRow& row = equations.rows[first + s];
        for (std::size_t i = 0; i < 3; ++i) {
            if (row.unknowns[i] == kNoReceiver)
                continue;
            const auto weight = static_cast<Value>(sign * row.area * row.shares[i]);
            Value* const to = &b[row.unknowns[i] * stride];
            for (std::size_t c = 0; c < stride; ++c)
                to[c] += weight * samples[s * stride + c];
        }
    }
}

/// Copies x [unknowns][stride] to the values of all receivers, [receivers][stride].
template <class Value>
void spread_unknowns(const FitEquations& equations, std::span<const Value> x, std::size_t stride,
                     std::span<Value> receivers) {
    for (std::size_t p = 0; p < equations.unknown_of.size(); ++p) {
        const std::uint32_t u = equations.unknown_of[p];
        for (std::size_t c = 0; c < stride; ++c)
            receivers[p * stride + c] = u == kNoReceiver ? Value(0) : x[u * stride + c];
    }
}

} // namespace prt
