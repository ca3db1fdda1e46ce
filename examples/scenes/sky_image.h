#pragma once

#include "prt/core/environment.h"

namespace examples {

/// `prt::PreethamSky` with a sun of 2.5 degrees as a lat-long image. The lower half is ground of albedo about
/// 0.2. `turbidity` 2 (clear) to 10 (haze); `sun` is a unit vector with y > 0.
prt::Environment preetham_sky(int height, double turbidity, const glm::dvec3& sun);

struct SunnySky {
    glm::dvec3 sun;         ///< unit, y > 0
    double turbidity = 2.5; ///< 2 (clear) to 10 (haze)
    /// Ratio of irradiances (luminance): of a surface facing the sun by the sun alone, over the ground by the
    /// sky alone. Under a clear sky 5 to 8, less for a low sun.
    double sun_to_sky = 6;
    double white = 1; ///< radiance of white paper on the ground
};

/// Returns `prt::PreethamSky` with a sun of half a degree, which the air reddens if it is low. `height` is at
/// least 512, so that texels resolve the sun; the ground is lit as in the other skies.
prt::Environment sunny_sky(int height, const SunnySky& sky);

/// A clear night: dark blue, a little lighter towards the horizon, with a moon of half a degree.
prt::Environment night_sky(int height, const glm::dvec3& moon);

} // namespace examples
