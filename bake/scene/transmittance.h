#pragma once

#include "prt/ray_scene.h"
#include "prt/surfaces.h"

#include <limits>

namespace prt {

/// Share of light that reaches `origin` from `to` lengths of `direction` away, through what is cut out,
/// blended or glass.
float transmittance(const RayScene& rays, const Surfaces& surfaces, const glm::vec3& origin,
                    const glm::vec3& direction, float to = std::numeric_limits<float>::infinity());

/// Share of what a point of triangle `target` sends that arrives at `origin`, from which `way` leads to the
/// point. Where surfaces coincide the ray meets one of them, as any other ray does.
float arriving_from(const RayScene& rays, const Surfaces& surfaces, const glm::vec3& origin,
                    const glm::vec3& way, std::uint32_t target);

} // namespace prt
