#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace prt {

/// One of many, how often it was drawn, and how many all of these together stand for.
struct Picked {
    std::uint32_t index;
    std::size_t times;
    double stands_for;
};

/// About `count` of [0, all), those of larger `likely(i)` more often: sums over what is picked, times what it
/// stands for, are those over all. Systematic sampling: evenly along the sum of `likely`.
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
