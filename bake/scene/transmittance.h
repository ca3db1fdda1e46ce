#pragma once

#include "prt/ray_scene.h"
#include "prt/surfaces.h"

namespace prt {

/// Share of light that reaches `origin` from far away along `direction`, through what is cut out, blended or
/// glass.
float transmittance(const RayScene& rays, const Surfaces& surfaces, const glm::vec3& origin,
                    const glm::vec3& direction);

} // namespace prt
