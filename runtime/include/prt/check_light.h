#pragma once

// Validation of lighting coefficients. Experimental.

#include "prt/light.h"

namespace prt {

/// Maximum magnitude of a lighting coefficient. Sums of squares of such coefficients still fit a float.
inline constexpr float kMaxLight = 1e18f;

/// Throws `Error` unless every coefficient is a number from -kMaxLight to kMaxLight.
void check_light(const Light& light);

} // namespace prt
