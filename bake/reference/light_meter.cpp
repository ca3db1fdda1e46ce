// Weights the receivers visible in a picture by the area that they cover.

#include "bake/reference/light_meter.h"

#include "bake/reference/sun_light.h"
#include "prt/core/light.h"
#include "runtime/render/lightmap_lookup.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <optional>

namespace prt {
namespace {

constexpr int kMaxAcross = 48; ///< maximum number of rays along each axis
/// Brighter than the middle grey of photographs (0.18), at which plaster looks grey.
constexpr float kMeanShown = 0.22f;

} // namespace

LightMeter::LightMeter(const Picture& picture, const RayScene& ray_scene) {
    const PrimaryRays rays(picture, ray_scene, std::min(picture.width, kMaxAcross),
                           std::min(picture.height, kMaxAcross));
    struct Reading {
        std::uint32_t receiver;
        glm::vec3 weight;
    };
    std::vector<Reading> readings;
    std::optional<LightmapLookup> lightmaps;
    if (picture.in_shader.lightmaps.layout)
        lightmaps.emplace(*picture.scene, *picture.in_shader.lightmaps.layout);
    float covered = 0;
    for (int y = 0; y < rays.rows(); ++y)
        for (int x = 0; x < rays.columns(); ++x)
            rays.walk(x, y, [&](const SeenSurface& surface, float transmittance) {
                const float share = transmittance * surface.base.a;
                const glm::vec2 uv = glm::clamp(surface.barycentrics, 0.0f, 1.0f);
                const glm::vec3 luminances = share * glm::vec3(kLuminance) * glm::vec3(surface.base);
                if (lightmaps) {
                    const BilinearTexels filter = lightmaps->filter(surface.triangle, uv);
                    for (std::size_t i = 0; i < 4; ++i)
                        readings.push_back(
                            {filter.texels[i], static_cast<float>(filter.weights[i]) * luminances});
                } else {
                    const glm::vec3 corners(std::max(0.0f, 1 - uv.x - uv.y), uv.x, uv.y);
                    for (int corner = 0; corner < 3; ++corner)
                        readings.push_back({surface.receivers[corner], corners[corner] * luminances});
                }
                covered += share;
            });
    std::stable_sort(readings.begin(), readings.end(),
                     [](const Reading& a, const Reading& b) { return a.receiver < b.receiver; });
    for (const Reading& reading : readings) {
        if (receivers_.empty() || receivers_.back() != reading.receiver) {
            receivers_.push_back(reading.receiver);
            weights_.emplace_back(0);
        }
        weights_.back() += reading.weight / covered;
    }
}

float LightMeter::luminance(std::span<const glm::vec3> radiance) const {
    float sum = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i)
        sum += glm::dot(weights_[i], glm::max(radiance[i], glm::vec3(0)));
    return sum;
}

float sun_luminance(const Picture& picture, const TraceScene& scene) {
    constexpr int kPoints = 8; // points per disc: the mean over the picture smooths penumbrae
    const PrimaryRays rays(picture, scene.rays(), std::min(picture.width, kMaxAcross),
                           std::min(picture.height, kMaxAcross));
    const SunLight suns(picture, scene, kPoints);
    glm::vec3 sum(0);
    float covered = 0;
    for (int y = 0; y < rays.rows(); ++y)
        for (int x = 0; x < rays.columns(); ++x)
            rays.walk(x, y, [&](const SeenSurface& surface, float transmittance) {
                const float share = transmittance * surface.base.a;
                sum += share * suns.radiance(surface, {rays.direction(x, y), rays.solid_angle(x, y)}, {});
                covered += share;
            });
    return covered > 0 ? glm::dot(glm::vec3(kLuminance), sum) / covered : 0.0f;
}

float exposure_for(float luminance) {
    return luminance > 0 ? kMeanShown / luminance : 1.0f;
}

} // namespace prt
