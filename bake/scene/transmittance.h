#pragma once

// Transmittance along shadow rays.

#include "bake/scene/ray_scene.h"
#include "bake/scene/surfaces.h"

#include <limits>

namespace prt {

/// Share of light that reaches `origin` from the distance of `to` lengths of `direction`, through cut-outs,
/// blended surfaces and glass.
float transmittance(const RayScene& rays, const Surfaces& surfaces, const glm::vec3& origin,
                    const glm::vec3& direction, float to = std::numeric_limits<float>::infinity());

/// Share of the light from a point of triangle `target` that arrives at `origin`. `way` is the vector from
/// `origin` to the point. If surfaces coincide the ray hits one of them, like any other ray.
float arriving_from(const RayScene& rays, const Surfaces& surfaces, const glm::vec3& origin,
                    const glm::vec3& way, std::uint32_t target);

} // namespace prt
