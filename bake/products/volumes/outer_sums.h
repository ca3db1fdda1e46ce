#pragma once

// Sums of outer products in blocks: each element of the sums is read and written once per kAtOnce products.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// Computes sums[o][i] = sum over all added products of weights[o] values[i].
class OuterSums {
public:
    static constexpr std::size_t kAtOnce = 16, kMaxRows = 16;

    /// Sets the sums to zero, [rows][columns], with at most kMaxRows rows. Reuses its memory.
    void begin(std::size_t rows, std::size_t columns);

    struct Room {
        std::span<float> weights; ///< [rows], to be written by the caller
        std::span<float> values;  ///< [columns or a few more], of which the caller writes the first [columns]
    };
    /// Returns space for the next product; the caller writes it before the next call. Additional columns stay
    /// zero.
    Room add();

    /// Row `row` of the sums, [columns or a few more].
    std::span<const float> row(std::size_t row);

private:
    void flush();

    std::size_t rows_ = 0, columns_ = 0, count_ = 0;
    std::array<std::array<float, kMaxRows>, kAtOnce> weights_{};
    std::vector<float> values_, sums_;
};

} // namespace prt
