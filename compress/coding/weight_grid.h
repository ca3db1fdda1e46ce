#pragma once

// Grids of quantised weights.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace prt {

/// The values that a weight may have: evenly spaced over [-1, 1] including both ends, or unrestricted.
class WeightGrid {
public:
    static WeightGrid any() { return WeightGrid(0); }
    /// Returns a grid of 2^bits values, symmetric about zero, without zero.
    static WeightGrid of_bits(int bits) { return WeightGrid(0.5f * (static_cast<float>(1u << bits) - 1.0f)); }

    bool is_any() const { return !(steps_ > 0); }
    /// Steps from 0 to 1; values are w = q / steps - 1, q = 0, 1, ...
    float steps() const { return steps_; }
    /// Bit width of q.
    int bits() const { return std::bit_width(static_cast<unsigned>(2 * steps_)); }
    float nearest(float weight) const {
        return is_any() ? weight : std::round((std::clamp(weight, -1.0f, 1.0f) + 1) * steps_) / steps_ - 1;
    }
    /// Returns the value of q.
    float at(std::uint32_t q) const { return static_cast<float>(q) / steps_ - 1; }
    /// Returns the q of a weight on the grid.
    long index_of(float weight) const { return std::lround((weight + 1) * steps_); }

private:
    explicit WeightGrid(float steps) : steps_(steps) {}
    float steps_;
};

} // namespace prt
