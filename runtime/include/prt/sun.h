#pragma once

// A sun that is separate from the sky, so that a renderer can shadow it. Stable.

#include "prt/light.h"

#include <glm/vec3.hpp>

#include <span>

namespace prt {

/// A sun: a distant disc of uniform radiance, or a directional light if `half_angle` is 0.
struct Sun {
    glm::vec3 towards = {0, 1, 0}; ///< unit direction from the receiver to the center of the disc
    /// Irradiance on a receiver that faces the center of the disc: linear Rec. 709, in the unit of the sky's
    /// radiance times sr. An unoccluded receiver of albedo 1 then has the exit radiance irradiance / pi.
    glm::vec3 irradiance{0};
    double half_angle = 0; ///< angle from the center of the disc to its rim, radians, 0..pi/2
};

/// Returns `sun` as SH radiance coefficients of `order` bands (docs/math.md, eq. 14), for example for
/// `Lighting::suns`. Throws `Error` for an order outside 1..kMaxOrder, a half angle outside 0..pi/2, a
/// direction of length 0, values that are not finite, and coefficients that overflow a float.
Light as_light(const Sun& sun, int order);
/// Returns the sum of all `suns` as SH radiance coefficients of `order` bands, for example for
/// `Lighting::suns`; all coefficients are 0 if `suns` is empty. Throws `Error` for an order outside
/// 1..kMaxOrder, for a sun that the other overload rejects, and for a sum that overflows a float.
Light as_light(std::span<const Sun> suns, int order);

} // namespace prt
