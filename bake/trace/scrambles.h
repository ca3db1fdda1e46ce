#pragma once

// Transfer vectors of one receiver by two scrambles of its rays.

#include <cstdint>
#include <span>

namespace prt {

/// Added to a seed, gives samples independent of those of the seed.
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
