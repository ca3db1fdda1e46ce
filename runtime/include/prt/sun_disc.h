#pragma once

// A sun that is lit apart from the sky. Stable.

#include "prt/light.h"

#include <glm/vec3.hpp>

#include <span>

namespace prt {

/// A disc of uniform radiance far away, directional where it has no extent.
struct SunDisc {
    glm::vec3 towards = {0, 1, 0}; ///< unit direction to its middle
    glm::vec3 irradiance{0};       ///< on a receiver that faces it
    double half_angle = 0;         ///< radians
    double energy_share = 0;       ///< of the luminance that all directions of its image together give
};

/// A sun as SH coefficients (docs/math.md, eq. 14): what lights transfer after a bounce. Throws `Error` for a
/// half angle outside 0..pi/2 and for what is not finite.
Light as_light(const SunDisc& sun, int order);
/// Suns together.
Light as_light(std::span<const SunDisc> suns, int order);

} // namespace prt
