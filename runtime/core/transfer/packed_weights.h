#pragma once

// Extracts the weights of a receiver from its bytes.

#include "prt/core/clustered_bases.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace prt {

template <class Stored>
[[gnu::always_inline]] inline Stored load(const std::byte* from) {
    Stored value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

[[gnu::always_inline]] inline int width_of(const ClusterLayout& layout, std::size_t component) {
    return 1 + static_cast<int>(layout.widths[component / 8] >> (4 * (component % 8)) & 15u);
}

/// Returns the cluster index in the first word of a receiver; 0 with 0 bits.
[[gnu::always_inline]] inline std::uint32_t cluster_in(const std::byte* words, int cluster_bits) {
    return load<std::uint32_t>(words) & ((1u << cluster_bits) - 1);
}

/// Returns `width` bits of `words` starting at bit `position`, width <= 16.
[[gnu::always_inline]] inline std::uint32_t bits_at(const std::byte* words, std::size_t position, int width) {
    const std::size_t word = position / 32, shift = position % 32;
    std::uint64_t bits = load<std::uint32_t>(words + word * 4);
    if (shift + static_cast<std::size_t>(width) > 32)
        bits |= static_cast<std::uint64_t>(load<std::uint32_t>(words + word * 4 + 4)) << 32;
    return static_cast<std::uint32_t>(bits >> shift) & ((1u << width) - 1);
}

} // namespace prt
