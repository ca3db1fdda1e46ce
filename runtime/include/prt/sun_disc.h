#pragma once

// A sun that is stored separately from the sky. Stable.

#include "prt/light.h"

#include <glm/vec3.hpp>

#include <span>

namespace prt {

/// A distant disc of uniform radiance, or a directional light if `half_angle` is 0.
struct SunDisc {
    glm::vec3 towards = {0, 1, 0}; ///< unit direction to its center
    glm::vec3 irradiance{0};       ///< on a receiver that faces it
    double half_angle = 0;         ///< radians
    double energy_share = 0;       ///< luminance of the sun as a fraction of the total over all directions of
                                   ///< its image
};

/// Returns a sun as SH coefficients (docs/math.md, eq. 14), for `Lighting::suns`. Throws `Error` for a half
/// angle outside 0..pi/2 and for values that are not finite.
Light as_light(const SunDisc& sun, int order);
/// Returns the sum of all `suns` as SH coefficients, for `Lighting::suns`.
Light as_light(std::span<const SunDisc> suns, int order);

} // namespace prt
