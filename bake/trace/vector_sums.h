#pragma once

// Weighted sums of traced vectors, computed on the device that traces them.

#include "bake/trace/tracer.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>

namespace prt {

/// Index that means that there is no sum.
inline constexpr std::uint32_t kNoSum = ~0u;

/// Sums that the vector of a receiver or sample is added to.
struct SumRow {
    std::array<std::uint32_t, 3> sums; ///< indices of sums, or kNoSum
    std::array<float, 3> weights;
    float sign = 1; ///< 1 or -1: factor of the vector in the signed sums
};

/// Rows of all receivers or samples.
struct SumRows {
    std::size_t count;
    std::function<SumRow(std::size_t)> row;
    std::span<const float> weights; ///< [sums] total weight of the vectors that are added to each sum
};

/// Number of coefficients that `VectorSums::trace` returns.
constexpr std::size_t first_coefficients(int order) {
    return static_cast<std::size_t>(order < 3 ? order * order : 9);
}

/// Sums of vectors on a device.
class VectorSums {
public:
    virtual ~VectorSums() = default;
    /// Traces like Tracer::trace, and adds the vector of receivers[indices[i]] to the sums of rows[i] instead
    /// of returning it. `first` [indices][...]: the first_coefficients of each vector.
    virtual void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                       const TraceOptions& options, std::span<const SumRow> rows, std::span<float> first,
                       const HitSink& sink, const Progress& progress) = 0;
    /// Writes the sums and the signed sums: [sums][order²].
    virtual void read(std::span<float> sums, std::span<float> signed_sums) = 0;
};

} // namespace prt
