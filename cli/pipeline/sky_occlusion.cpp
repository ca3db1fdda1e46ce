// Computes sky occlusion from transfer of probes.

#include "cli/pipeline/sky_occlusion.h"

#include "prt/core/error_measures.h"
#include "prt/core/light.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <span>

namespace prt::pipeline {
namespace {

/// Irradiance over pi of four coefficients, or of the first alone.
float grey_irradiance(std::span<const float> light, const glm::vec3& normal) {
    std::array<glm::vec3, 4> coefficients{};
    for (std::size_t i = 0; i < light.size(); ++i)
        coefficients[i] = glm::vec3(light[i]);
    return irradiance_of(coefficients, normal).x;
}

} // namespace

SkyOcclusion::SkyOcclusion(const BakedVolume& volume, int threads) {
    const Lighting white{constant_light(volume.baked.transfer.layout.order, glm::vec3(1))};
    const std::vector<glm::vec3> incident = exit_radiance(volume.baked.transfer, white, threads);
    const std::size_t coefficients = volume.coefficients();
    probes_.resize(volume.visibility.size());
    for (std::size_t p = 0; p < probes_.size(); ++p)
        for (std::size_t o = 0; o < 4; ++o)
            probes_[p][o] = luminance(incident[p * coefficients + o]);
}

glm::vec3 SkyOcclusion::irradiance(const VolumeCorners& corners, const glm::vec3& normal, const Light& sky,
                                   SkyOcclusionKind kind) const {
    std::array<float, 4> light{};
    for (std::size_t i = 0; i < corners.probes.size(); ++i)
        for (std::size_t o = 0; o < 4; ++o)
            light[o] += corners.weights[i] * probes_[corners.probes[i]][o];
    const glm::vec3 mean(-light[3], -light[1], light[2]); // Y1-1 is -y, Y10 z, Y11 -x
    const glm::vec3 from =
        kind == SkyOcclusionKind::directed && glm::length(mean) > 0 ? glm::normalize(mean) : normal;
    const std::size_t numbers = kind == SkyOcclusionKind::number ? 1 : 4;
    const float open = grey_irradiance(std::span(light).first(numbers), normal);
    return open * irradiance_of(std::span(sky.coefficients).first(9), from);
}

} // namespace prt::pipeline
