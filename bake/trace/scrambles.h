#pragma once

// Comparison of transfer vectors from two scrambles of rays.

#include <cstdint>
#include <span>

namespace prt {

/// Offset of a seed that makes its samples independent of those of the original seed.
inline constexpr std::uint64_t kSecondScramble = 0x9e3779b97f4a7c15;

inline double squared_distance(std::span<const float> a, std::span<const float> b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        sum += static_cast<double>((a[k] - b[k]) * (a[k] - b[k]));
    return sum;
}

inline double product(std::span<const float> a, std::span<const float> b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        sum += static_cast<double>(a[k] * b[k]);
    return sum;
}

inline double squared_norm(std::span<const float> a) {
    return product(a, a);
}

} // namespace prt
