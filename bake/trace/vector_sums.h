#pragma once

// Weighted sums of traced vectors, made where they are traced.

#include "prt/tracer.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>

namespace prt {

inline constexpr std::uint32_t kNoSum = ~0u;

/// What the vector of a receiver, or of a sample, is added to.
struct SumRow {
    std::array<std::uint32_t, 3> sums; ///< or kNoSum
    std::array<float, 3> weights;
    float sign = 1; ///< or -1: with which it goes to the signed sums, too
};

/// Of all there are.
struct SumRows {
    std::size_t count;
    std::function<SumRow(std::size_t)> row;
    std::span<const float> weights; ///< [sums]: what is added to each has so much weight in all
};

/// Coefficients that `VectorSums::trace` hands out.
constexpr std::size_t first_coefficients(int order) {
    return static_cast<std::size_t>(order < 3 ? order * order : 9);
}

class VectorSums {
public:
    virtual ~VectorSums() = default;
    /// Traces as Tracer::trace does, and adds the vector of receivers[indices[i]] by rows[i] instead of
    /// handing it out. `first` [indices][...]: the first_coefficients of each.
    virtual void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                       const TraceOptions& options, std::span<const SumRow> rows, std::span<float> first,
                       const HitSink& sink, const Progress& progress) = 0;
    /// Writes the sums, and those with signs: [sums][order²].
    virtual void read(std::span<float> sums, std::span<float> signed_sums) = 0;
};

} // namespace prt
