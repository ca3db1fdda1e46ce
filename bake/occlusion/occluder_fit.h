#pragma once

// The texels of an occlusion volume whose interpolation comes nearest to what points see.

#include "prt/occlusion_volume.h"

#include <glm/vec3.hpp>

#include <span>

namespace prt {

/// What is blocked from a point.
struct BlockedPoint {
    glm::vec3 at{0};   ///< in the box, 0..1 along each side
    float blocked = 0; ///< of all directions
    glm::vec3 lean{0}; ///< as of `cap_of`, in the object's frame
};

/// Least squares of sqrt(blocked), which is near to 1 / distance, and of the lean where it counts; where no
/// point is, inside of the object, texels are as smooth as they can be (docs/math.md, section 20).
void fit_texels(std::span<const BlockedPoint> points, OcclusionVolume& volume);

} // namespace prt
