#pragma once

// The edge of a sun's disc, to a fraction of a texel.

#include "spot.h"

namespace prt {

struct Disc {
    glm::dvec3 towards{0};
    double half_angle = 0; ///< radians
};

/// Fits a disc over a sky that goes up or down across it to the texels about `spot`. Where the spot is too
/// narrow for texels to show its edge: the disc that is as bright as its peak and has its light.
Disc fitted_disc(const SkyMap& map, const Spot& spot);

} // namespace prt
