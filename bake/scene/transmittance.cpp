// Follows a shadow ray through all surfaces that let some of it pass.

#include "scene/transmittance.h"

#include <cmath>

namespace prt {

float transmittance(const RayScene& rays, const Surfaces& surfaces, const glm::vec3& origin,
                    const glm::vec3& direction, float to) {
    Ray ray{origin, direction, 0, to};
    if (!surfaces.traits().alpha)
        return rays.occluded(ray) ? 0.0f : 1.0f;
    float left = 1;
    while (left > 0) {
        const std::optional<RayHit> met = rays.nearest(ray);
        if (!met)
            break;
        left *= 1 - surfaces.coverage({met->triangle, met->uv, 0});
        ray.from = std::nextafter(met->distance, std::numeric_limits<float>::infinity());
    }
    return left;
}

} // namespace prt
