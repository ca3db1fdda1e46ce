#pragma once

// Whether lighting can be computed with. Experimental.

#include "prt/light.h"

namespace prt {

/// The brightest coefficient that is taken in: sums of squares of such lights are still floats.
inline constexpr float kMostLight = 1e18f;

/// Throws `Error` unless every coefficient is a number from -kMostLight to kMostLight.
void check_light(const Light& light);

} // namespace prt
