// Measures exit radiance at the visible receivers and computes the exposure from it.

#include "core/exposure.h"

#include "core/texel_light.h"

#include "prt/core/sh.h"
#include "prt/render/tone_map.h"

#include <algorithm>

namespace viewer {
namespace {

using Indices = std::span<const std::uint32_t>; ///< receivers in ascending order

glm::vec3 normal_of(const prt::Scene& scene, std::uint32_t receiver) {
    const auto array = std::prev(std::upper_bound(
        scene.vertex_arrays.begin(), scene.vertex_arrays.end(), receiver,
        [](std::uint32_t r, const prt::VertexArray& vertices) { return r < vertices.first_receiver; }));
    return array->normals[receiver - array->first_receiver];
}

/// Returns the unshadowed exit radiance of the receivers for albedo 1.
std::vector<glm::vec3> unshadowed(const prt::Scene& scene, const prt::Light& light, Indices receivers) {
    const prt::Light bands = prt::truncated(light, 3);
    const prt::TransferLayout layout = prt::layout_of_one(3, 1, prt::TermKind::direct);
    std::vector<glm::vec3> radiance;
    std::vector<float> lobe(9);
    for (const std::uint32_t receiver : receivers) {
        prt::evaluate_sh(3, normal_of(scene, receiver), lobe);
        for (std::size_t i = 0; i < 9; ++i)
            lobe[i] *= static_cast<float>(prt::clamped_cosine_factor(i == 0 ? 0 : i < 4 ? 1 : 2));
        radiance.push_back(prt::exit_radiance(lobe, layout, bands.coefficients));
    }
    return radiance;
}

std::vector<glm::vec3> baked(const prt::Transfer& raw, const prt::Lighting& lighting, Indices receivers) {
    const std::vector<glm::vec3> columns = prt::light_columns(raw.layout, lighting);
    std::vector<glm::vec3> radiance;
    for (const std::uint32_t receiver : receivers)
        radiance.push_back(prt::exit_radiance(raw.vector(receiver), raw.layout, columns));
    return radiance;
}

std::vector<glm::vec3> compressed(const prt::ClusteredTransfer& transfer, const prt::Lighting& lighting,
                                  Indices receivers) {
    const std::vector<glm::vec3> all = prt::exit_radiance(transfer, lighting);
    std::vector<glm::vec3> radiance;
    for (const std::uint32_t receiver : receivers)
        radiance.push_back(all[receiver]);
    return radiance;
}

/// Returns the factor on the exposure at night. Eyes adapt only in part, so that night stays dark and
/// brighter lamps look brighter (compare the key of G. Krawczyk et al., "Perceptual Effects in Real-time Tone
/// Mapping", 2005, which falls with luminance). The constants were chosen by eye for the courtyard: luminance
/// 0.06 from its lanterns is shown as 0.1.
float night_share(float luminance, float darkness) {
    constexpr float kDaylight = 0.5f, kPower = 0.4f;
    return std::pow(std::min(1.0f, luminance / kDaylight), kPower * darkness);
}

/// Returns the exit radiance from the transfer that exists, or the unshadowed radiance without transfer.
std::vector<glm::vec3> radiance_at(const LoadedModel& loaded, const prt::Light& light,
                                   const LampSettings& lamps, Indices receivers) {
    if (!loaded.raw && !loaded.compressed)
        return unshadowed(loaded.model->scene, light, receivers);
    const prt::Lighting lighting =
        with_lamps({light}, lamps, loaded.compressed ? loaded.compressed->bases.layout : loaded.raw->layout);
    if (loaded.of_texels())
        return texel_radiance(loaded, lighting, receivers);
    return loaded.compressed ? compressed(*loaded.compressed, lighting, receivers)
                             : baked(*loaded.raw, lighting, receivers);
}

prt::LightMeter meter_of(const ExposureMeter::View& view, const prt::LightmapLayout* lightmaps) {
    prt::Picture picture = picture_of(*view.model, {}, view.camera, view.width, view.height);
    picture.textured = view.textured;
    picture.in_shader.lightmaps.layout = lightmaps;
    return {picture, view.model->trace->rays()};
}

} // namespace

float ExposureMeter::exposure(const View& view, const Lit& lit, const std::function<prt::Light()>& light) {
    if (view == view_ && lit.version == version_)
        return exposure_;
    const prt::LightmapLayout* const lightmaps = lit.loaded.lightmap.layout();
    if (view != view_ || lightmaps != lightmaps_)
        meter_ = meter_of(view, lightmaps);
    view_ = view;
    lightmaps_ = lightmaps;
    version_ = lit.version;
    const prt::Light all = light();
    const float luminance = meter_->luminance(radiance_at(lit.loaded, all, lit.lamps, meter_->receivers()));
    exposure_ = luminance > 0 ? prt::exposure_for(luminance) * night_share(luminance, lit.darkness)
                              : prt::automatic_exposure(all);
    return exposure_;
}

} // namespace viewer
