// Casts rays to suns from surfaces that a camera sees, as the path tracer does.

#include "bake/reference/sun_light.h"

#include "bake/scene/transmittance.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <numbers>

namespace prt {

SunLight::SunLight(const Picture& picture, const TraceScene& scene, int points)
    : picture_(picture), scene_(scene) {
    for (const Sun& sun : picture.suns)
        suns_.push_back({DiscDirections(sun.towards, sun.half_angle, points), sun.irradiance});
}

glm::vec3 SunLight::irradiance(const LitSide& side, const DiscSample& sample) const {
    glm::vec3 sum(0);
    for (const SampledSun& sun : suns_) {
        const int count = sun.directions.count(), stride = count > 1 ? sample.stride : 1;
        double arriving = 0;
        int taken = 0;
        for (int i = count > 1 ? sample.first : 0; i < count; i += stride, ++taken) {
            const glm::vec3 towards = sun.directions.direction(i, sample.turn);
            if (side.faces(towards))
                arriving += static_cast<double>(
                    glm::dot(side.normal, towards) *
                    transmittance(scene_.rays(), scene_.surfaces(), side.origin(), towards));
        }
        sum += sun.irradiance * static_cast<float>(arriving / (taken * sun.directions.mean_cosine()));
    }
    return sum;
}

Scattering SunLight::scattering(const SeenSurface& surface, float footprint) const {
    if (!scene_.surfaces().transmits(surface.triangle)) // base color as the picture filters it
        return {glm::vec3(surface.base), glm::vec3(0)};
    return seen_scattering(scene_.surfaces(), {surface.triangle, surface.barycentrics, footprint},
                           picture_.textured);
}

glm::vec3 SunLight::radiance(const SeenSurface& surface, const ViewRay& ray, const DiscSample& sample) const {
    if (scene_.surfaces().solid(surface.triangle)) // all light passes a medium
        return glm::vec3(0);
    const LitSide side =
        met_surface(*picture_.scene, scene_.rays(), {surface.triangle, surface.barycentrics, 0}, ray.along)
            .side;
    const glm::vec3 way = picture_.camera.position - side.position;
    const float distance = glm::length(way);
    const Scattering s =
        scattering(surface, ray.solid_angle * distance * distance * distance / glm::dot(side.face, way));
    glm::vec3 radiance = s.reflected * irradiance(side, sample);
    if (s.transmitted != glm::vec3(0))
        radiance += s.transmitted * irradiance(side.other(), sample);
    return radiance / std::numbers::pi_v<float>;
}

} // namespace prt
