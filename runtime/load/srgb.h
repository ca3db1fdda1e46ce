#pragma once

#include <algorithm>
#include <cmath>

namespace prt {

/// Returns the linear value of an sRGB value (IEC 61966-2-1), both 0..1; values outside are clamped, NaN is
/// 0.
inline float srgb_to_linear(double value) {
    value = value > 0 ? std::min(value, 1.0) : 0;
    return static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
}

} // namespace prt
