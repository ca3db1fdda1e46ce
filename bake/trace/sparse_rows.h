#pragma once

// Vectorised product of sparse rows with transfer vectors.

#include <cstdint>
#include <span>

namespace prt {

struct SparseRow {
    std::uint32_t count;
    const std::uint32_t* sources; ///< [count]
    const float* weights;         ///< [count][channels, or 1]
};

/// Computes to[row] = sum over entries of weight · from[source]; `from` and `to` are [..][channels][order²].
/// `one_weight`: an entry has one weight for all channels.
void apply_rows(int order, int channels, bool one_weight, std::span<const SparseRow> rows, const float* from,
                float* to);

} // namespace prt
