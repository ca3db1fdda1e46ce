#pragma once

// Importance sampling of a subset.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace prt {

/// Element of a subset: its index, how often it was drawn, and the number of elements that all its draws
/// represent.
struct Picked {
    std::uint32_t index;
    std::size_t times;
    double weight;
};

/// Picks about `count` of [0, all) with a probability in proportion to `likely(i)`. Sums over the picked
/// elements, multiplied by `weight`, estimate sums over all. Systematic sampling: even steps along the
/// sum of `likely`.
template <class Likely>
std::vector<Picked> pick(std::size_t all, std::size_t count, Likely&& likely) {
    double sum = 0;
    for (std::size_t i = 0; i < all; ++i)
        sum += likely(i);
    const double step = sum / static_cast<double>(count);
    std::vector<Picked> picked;
    double reached = 0, next = 0.5 * step;
    for (std::size_t i = 0; i < all && step > 0; ++i) {
        const double here = likely(i);
        reached += here;
        std::size_t times = 0;
        for (; next < reached; next += step)
            ++times;
        if (times > 0)
            picked.push_back(
                {static_cast<std::uint32_t>(i), times, static_cast<double>(times) * step / here});
    }
    return picked;
}

} // namespace prt
