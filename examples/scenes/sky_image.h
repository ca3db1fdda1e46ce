#pragma once

#include "prt/environment.h"

namespace examples {

/// `prt::PreethamSky` with a sun as a lat-long image. The lower half is ground of albedo about 0.2.
/// `turbidity` 2 (clear) to 10 (haze); `sun` is a unit vector with y > 0.
prt::Environment preetham_sky(int height, double turbidity, const glm::dvec3& sun);

} // namespace examples
