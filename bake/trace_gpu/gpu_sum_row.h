#pragma once

// Rows of sums in the layout of shaders, and their fixed-point values.

#include "bake/trace/vector_sums.h"
#include "shared_structs.h"

#include <span>

namespace prt {

/// Converts a row to the layout of shaders. `weights` [sums]: total weight of each sum.
inline gpu::SumRow gpu_sum_row(const SumRow& row, std::span<const float> weights) {
    static_assert(kNoSum == PRT_NO_SUM);
    gpu::SumRow result{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t sum = row.sums[i];
        result.sums[i] = sum;
        result.shares[i] = sum != kNoSum && weights[sum] > 0 ? row.weights[i] / weights[sum] : 0.0f;
    }
    result.sign = row.sign;
    return result;
}

/// Converts a sum from fixed point. `largest`: maximum of the summed values.
inline float from_fixed_point(std::int32_t fixed, float weight, float largest = 1) {
    return static_cast<float>(static_cast<double>(fixed) / PRT_FIXED_ONE * static_cast<double>(weight) *
                              static_cast<double>(largest));
}

} // namespace prt
