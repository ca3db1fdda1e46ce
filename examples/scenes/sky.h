#pragma once

#include "prt/environment.h"

namespace examples {

/// A clear sky with a sun as a lat-long image: A. J. Preetham, P. Shirley and B. Smits, "A Practical Analytic
/// Model for Daylight", SIGGRAPH 1999. Radiance relative to that of the zenith at noon. The lower half is
/// ground of albedo about 0.2. `turbidity` 2 (clear) to 10 (haze); `sun` is a unit vector with y > 0.
prt::Environment preetham_sky(int height, double turbidity, const glm::dvec3& sun);

} // namespace examples
