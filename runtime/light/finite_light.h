#pragma once

#include "prt/light.h"
#include "prt/support/error.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace prt {

/// Whether red, green and blue are numbers, and none is infinite.
inline bool is_finite(const glm::vec3& color) {
    return std::isfinite(color.x) && std::isfinite(color.y) && std::isfinite(color.z);
}

/// Throws `Error` where a coefficient is not finite: the color that it was made of was not, or is so large
/// that floats do not hold what came of it.
inline void check_finite(std::span<const glm::vec3> coefficients) {
    if (!std::ranges::all_of(coefficients, is_finite))
        throw Error(
            "the coefficients of the light are not finite: its color is not, or too large for floats");
}

/// `light` as a function hands it on, checked.
inline Light finite_light(Light light) {
    check_finite(light.coefficients);
    return light;
}

} // namespace prt
