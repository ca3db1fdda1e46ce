#pragma once

// Fits the texels of an occlusion volume so that their interpolation matches the occlusion at points.

#include "prt/core/occlusion_volume.h"

#include <glm/vec3.hpp>

#include <span>

namespace prt {

/// Occlusion at a point.
struct BlockedPoint {
    glm::vec3 at{0};                ///< coordinates in the box, 0..1 along each side
    float blocked = 0;              ///< blocked share of all directions
    glm::vec3 blocked_direction{0}; ///< argument of `cap_of`, in the object's frame
};

/// Fits the texels of `volume` to `points` by least squares: sqrt(blocked), which is approximately
/// proportional to 1 / distance, and the mean blocked direction, weighted by the blocked share. Texels
/// without points, inside the object, are as smooth as possible (docs/math.md, section 20).
void fit_texels(std::span<const BlockedPoint> points, OcclusionVolume& volume);

} // namespace prt
