#pragma once

// Sun and sky apart: a game casts a sharp shadow from the sun and relights the rest with transfer. Stable.

#include "prt/light.h"

#include <vector>

namespace prt {

/// A light that a fit has found: a cone of uniform radiance, directional where it is narrow.
struct FittedLight {
    glm::vec3 towards = {0, 1, 0}; ///< unit direction to it
    glm::vec3 irradiance;          ///< on a receiver that faces it
    double half_angle = 0; ///< radians, at most kWidestFittedLight; narrower than 0.05 cannot be told from 0
    double energy_share =
        0; ///< of the luminance that all directions together give; the remainder has the rest
};

inline constexpr double kWidestFittedLight = 0.35;

struct SunFit {
    std::vector<FittedLight> lights; ///< the strongest first; fewer than asked for where there are no more
    Light remainder;                 ///< what is left, of the order asked for
    double remainder_share = 1;
};

/// Finds up to `count` lights in `environment`, the lighting at kMaxOrder. What a smooth sky can have, bands
/// below 4, is the remainder's; the lights are those whose higher bands come nearest to the lighting's:
/// starting at the highest peaks, then together by least squares (Ceres). The remainder has `order` bands;
/// with the lights it adds up to `environment` exactly in them. Throws `Error` for an order
/// outside 1..kMaxOrder, lighting of fewer than kMaxOrder bands or not finite, and a count that is not
/// positive.
SunFit fit_suns(const Light& environment, int order, int count);

/// A fitted light as SH coefficients.
Light as_light(const FittedLight& light, int order);

} // namespace prt
