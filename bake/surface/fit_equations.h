#pragma once

// Which values vertices must have so that their interpolation comes nearest to samples of the surface (L.
// Kavan, A. W. Bargteil and P.-P. Sloan, "Least Squares Vertex Baking", EGSR 2011; docs/math.md, section 14).

#include "surface/smoothness.h"
#include "surface/surface_samples.h"
#include "trace/vector_sums.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// What a sample is of the unknowns: Σ shares_i x_i, with the weight `area`.
struct FitRow {
    std::array<std::uint32_t, 3> unknowns; ///< kNoReceiver: none
    std::array<float, 3> shares;
    float area; ///< m²
};

/// The least-squares problem Σ_s a_s (Σ_i φ_i(s) x_i - T_s)². Receivers that are alike are one unknown x_i;
/// those on no surface are none, and stay dark.
struct FitEquations {
    std::vector<std::uint32_t> unknown_of; ///< [receivers], kNoReceiver: none
    std::size_t unknowns = 0;
    std::vector<FitRow> rows; ///< [samples]
    std::vector<Bend> bends;  ///< of x
};
/// `alike` [receivers]: the first receiver that each is one unknown with.
FitEquations fit_equations(const Surfaces& surfaces, const TransportReceivers& receivers,
                           const SurfaceSamples& samples, std::span<const std::uint32_t> alike);

/// What a sample is added to in b, of positive sign.
SumRow sum_row(const FitRow& row);

/// How much weight the samples have in all that are added to each of b: [unknowns].
std::vector<float> unknown_weights(const FitEquations& equations);

/// Adds a_s φ_i(s) T_s times `sign` to b [unknowns][stride], for T of the samples from `first` on,
/// [some][stride].
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

/// The values of all receivers, [receivers][stride], of x [unknowns][stride].
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
