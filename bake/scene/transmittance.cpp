// Follows a shadow ray through all surfaces that transmit a part of it.

#include "bake/scene/transmittance.h"

#include <cmath>

namespace prt {
namespace {

/// Result of `follow`: the share of light that is left where the ray ends or before it hits the target.
struct Followed {
    float left = 1;
    std::optional<RayHit> target;
};
/// Follows `ray` through surfaces until nothing is left or it hits `target`.
Followed follow(const RayScene& rays, const Surfaces& surfaces, Ray ray,
                std::optional<std::uint32_t> target) {
    Followed followed;
    while (followed.left > 0) {
        const std::optional<RayHit> met = rays.nearest(ray);
        if (!met)
            break;
        if (met->triangle == target) {
            followed.target = met;
            break;
        }
        followed.left *= 1 - surfaces.coverage({met->triangle, met->uv, 0});
        ray.from = std::nextafter(met->distance, std::numeric_limits<float>::infinity());
    }
    return followed;
}

} // namespace

float transmittance(const RayScene& rays, const Surfaces& surfaces, const glm::vec3& origin,
                    const glm::vec3& direction, float to) {
    const Ray ray{origin, direction, 0, to};
    if (!surfaces.traits().alpha)
        return rays.occluded(ray) ? 0.0f : 1.0f;
    return follow(rays, surfaces, ray, std::nullopt).left;
}

float arriving_from(const RayScene& rays, const Surfaces& surfaces, const glm::vec3& origin,
                    const glm::vec3& way, std::uint32_t target) {
    constexpr float kBeyond = 1 + 1e-4f;
    const Followed followed = follow(rays, surfaces, {origin, way, 0, kBeyond}, target);
    return followed.target ? followed.left * surfaces.coverage({target, followed.target->uv, 0}) : 0.0f;
}

} // namespace prt
