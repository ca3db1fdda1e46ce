#pragma once

// Removes ringing from lighting: the negative radiance that truncation to `order` bands causes. Uses the
// weakest sufficient filter.
//
// The exit radiance of a receiver is the integral of light times its shadowed cosine. It is non-negative for
// every receiver under any shadowing if and only if the light is non-negative in every direction. The filter
// must satisfy this condition. Among all filters that do, the one that changes exit radiance least is used:
// docs/math.md, eq. 16 to 19. Stable.

#include "prt/light.h"
#include "prt/sh_basis.h"

#include <array>

namespace prt {

/// Factors of the bands, [l < order]; the factor of the mean (band 0) is 1.
using BandFactors = std::array<double, kMaxOrder>;

/// Returns the factors, 0..1, that make `light` non-negative in every direction and channel and change the
/// exit radiance of receivers least. All channels use the same factors, so that no hue shifts. Factors are 1
/// if nothing is negative. They do not depend on the rotation of the light: dering once, then rotate. A
/// channel whose mean is not positive, or less than a millionth of a coefficient, cannot be corrected and is
/// ignored. Throws `Error` for a light that is not finite, or above 1e37. At order 6 this takes 0.3 to 0.9 ms
/// on an idle core, depending on the number of iterations.
BandFactors dering_factors(const Light& light);

/// Returns `light` times its `dering_factors`; equals `windowed(light, Window::automatic)`.
Light deringed(const Light& light);

/// Returns `light` with each band multiplied by its factor.
Light with_band_factors(const Light& light, const BandFactors& factors);

} // namespace prt
