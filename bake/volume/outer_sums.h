#pragma once

// Sums of outer products, many at a time: each number of the sums is read and written once for kAtOnce.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// sums[o][i] = sum over all that were added of weights[o] values[i].
class OuterSums {
public:
    static constexpr std::size_t kAtOnce = 16, kMostRows = 16;

    /// Zero, [rows][columns], kMostRows at most. Keeps its space.
    void begin(std::size_t rows, std::size_t columns);

    struct Room {
        std::span<float> weights; ///< [rows], to be written
        std::span<float> values;  ///< [columns or a few more], the first of which are to be written
    };
    /// Adds what is written there until the next call; more columns stay zero.
    Room add();

    /// Row `row`, [columns or a few more].
    std::span<const float> row(std::size_t row);

private:
    void flush();

    std::size_t rows_ = 0, columns_ = 0, count_ = 0;
    std::array<std::array<float, kMostRows>, kAtOnce> weights_{};
    std::vector<float> values_, sums_;
};

} // namespace prt
