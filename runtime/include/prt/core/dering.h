#pragma once

// Removes ringing from lighting: the negative radiance that truncation to `order` bands causes. Uses the
// weakest sufficient filter.
//
// The exit radiance of a receiver is the integral of light times its shadowed cosine. It is non-negative for
// every receiver under any shadowing if and only if the light is non-negative in every direction. The filter
// must satisfy this condition. Among all filters that do, the one that changes exit radiance least is used:
// docs/math.md, eq. 16 to 19. Stable.

#include "prt/core/light.h"
#include "prt/core/sh_basis.h"

#include <array>

namespace prt {

/// Factors of the bands of a light: entry l multiplies all coefficients of band l. Entries from the order of
/// the light on are not used.
using BandFactors = std::array<double, kMaxOrder>;

/// Returns the factors, 0..1, that make the radiance of `light` non-negative in every direction and channel
/// and change the exit radiance of receivers least (docs/math.md, eq. 17). `light` must have at least one
/// band. Throws `Error` if a coefficient is not finite or exceeds 1e37 in magnitude.
///
/// The factor of band 0 is 1, so that the mean radiance does not change. All channels share the factors, so
/// that no hue shifts. All factors are 1 if no radiance is below 1 % of the mean of its channel. If the
/// smallest radiance is between 0 and this limit, factors can be up to 1 % below 1. A channel is ignored if
/// its band 0 coefficient is not positive, or is less than a millionth of the channel's largest coefficient:
/// an ignored channel may remain negative. Except for this tolerance of about 1 %, the factors do not depend
/// on the rotation of the light: dering once, then rotate. At order 6 a call takes 0.3 to 0.9 ms on an idle
/// core.
BandFactors dering_factors(const Light& light);

/// Returns `light` with each band multiplied by its factor of `dering_factors`; equals `windowed(light,
/// Window::automatic)`. `light` must have at least one band. Throws the errors of `dering_factors`.
Light deringed(const Light& light);

/// Returns `light` with all coefficients of band l multiplied by factors[l]. Throws `Error` if a resulting
/// coefficient is not finite.
Light with_band_factors(const Light& light, const BandFactors& factors);

} // namespace prt
