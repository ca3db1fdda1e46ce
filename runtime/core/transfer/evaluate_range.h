#pragma once

// Evaluation of compressed transfer for a range of receivers.

#include "prt/core/clustered_transfer.h"
#include "runtime/core/transfer/packed_weights.h"

namespace prt {

using Color [[gnu::vector_size(16)]] = float;
using ColorInMemory [[gnu::vector_size(16), gnu::aligned(4), gnu::may_alias]] = float;

[[gnu::always_inline]] inline Color color_at(const glm::vec4* row) {
    return *reinterpret_cast<const ColorInMemory*>(row);
}

/// Computes every output of receiver `p`, whose weights are packed, from the constants.
template <std::size_t Outputs>
[[gnu::always_inline]] inline void sum_outputs(const ClusteredReceivers& receivers,
                                               const ClusterLayout* layouts, const glm::vec4* constants,
                                               std::size_t p, Color (&sums)[Outputs]) {
    const std::byte* const words = receivers.weights.data() + p * receivers.stride();
    const ClusterLayout& layout = layouts[cluster_in(words, receivers.cluster_bits)];
    const glm::vec4* row = constants + layout.first_row * Outputs;
#pragma GCC unroll 16 // otherwise the sums are in memory, not in registers
    for (std::size_t o = 0; o < Outputs; ++o)
        sums[o] = color_at(row + o);
    auto position = static_cast<std::size_t>(receivers.cluster_bits);
    for (std::size_t j = 0; j < layout.components; ++j) {
        const int width = width_of(layout, j);
        const auto weight = static_cast<float>(bits_at(words, position, width));
        position += static_cast<std::size_t>(width);
        row += Outputs;
#pragma GCC unroll 16
        for (std::size_t o = 0; o < Outputs; ++o)
            sums[o] += weight * color_at(row + o);
    }
}

/// Throws `Error` unless `transfer` has the coordinates of its predictors.
void check_coordinates(const ClusteredTransfer& transfer);

/// Throws `Error` if `free_rows` freed the rows.
void check_rows(const ClusteredBases& bases);

/// Computes exit radiance of receivers [begin, end) from the constants; `radiance` starts at receiver
/// `begin`. Allocates nothing.
void evaluate_range(const ClusteredReceivers& receivers, const ClusterLayout* layouts,
                    const glm::vec4* constants, std::size_t begin, std::size_t end, glm::vec3* radiance);

} // namespace prt
