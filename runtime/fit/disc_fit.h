#pragma once

// Fits the outline of a sun's disc with subpixel precision.

#include "runtime/fit/spot.h"

namespace prt {

struct Disc {
    glm::dvec3 towards{0};
    double half_angle = 0; ///< radians
};

/// Fits a disc on a linear sky gradient to the texels about `spot`. If the spot is too narrow for texels to
/// resolve its edge, returns the disc with the brightness of its peak and the same total light.
Disc fitted_disc(const SkyMap& map, const Spot& spot);

} // namespace prt
