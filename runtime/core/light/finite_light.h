#pragma once

// Checks that lights are finite.

#include "prt/core/error.h"
#include "prt/core/light.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace prt {

/// Returns whether red, green and blue are finite numbers.
inline bool is_finite(const glm::vec3& color) {
    return std::isfinite(color.x) && std::isfinite(color.y) && std::isfinite(color.z);
}

/// Throws `Error` if a coefficient is not finite: the input color was not finite, or the result overflows a
/// float.
inline void check_finite(std::span<const glm::vec3> coefficients) {
    if (!std::ranges::all_of(coefficients, is_finite))
        throw Error("the coefficients of the light are not finite: its color is not finite or too large");
}

/// Returns `light` after the check.
inline Light finite_light(Light light) {
    check_finite(light.coefficients);
    return light;
}

} // namespace prt
