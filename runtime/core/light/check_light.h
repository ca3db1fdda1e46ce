#pragma once

// Validation of lighting coefficients. Experimental.

#include "prt/core/light.h"

namespace prt {

/// Maximum magnitude of a lighting coefficient that `check_light` accepts. Sums of squares of such
/// coefficients still fit a float.
inline constexpr float kMaxLight = 1e18f;

/// Throws `Error` if any channel of any coefficient of `light` is NaN or outside -kMaxLight..kMaxLight.
void check_light(const Light& light);

} // namespace prt
