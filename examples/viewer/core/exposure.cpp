#include "core/exposure.h"

#include "prt/sh.h"
#include "prt/tone_map.h"

#include <fmt/core.h>

#include <algorithm>

namespace viewer {
namespace {

using Receivers = std::span<const std::uint32_t>;

glm::vec3 normal_of(const prt::Scene& scene, std::uint32_t receiver) {
    const auto array = std::prev(std::upper_bound(
        scene.vertex_arrays.begin(), scene.vertex_arrays.end(), receiver,
        [](std::uint32_t r, const prt::VertexArray& vertices) { return r < vertices.first_receiver; }));
    return array->normals[receiver - array->first_receiver];
}

/// Exit radiance for albedo 1 of a few receivers.
std::vector<glm::vec3> unshadowed(const prt::Scene& scene, const prt::Light& light, Receivers receivers) {
    const prt::Light bands = prt::truncated(light, 3);
    std::vector<glm::vec3> radiance;
    std::vector<float> lobe(9);
    for (const std::uint32_t receiver : receivers) {
        prt::evaluate_sh(3, normal_of(scene, receiver), lobe);
        for (std::size_t i = 0; i < 9; ++i)
            lobe[i] *= static_cast<float>(prt::clamped_cosine_factor(i == 0 ? 0 : i < 4 ? 1 : 2));
        radiance.push_back(prt::exit_radiance(lobe, 1, bands));
    }
    return radiance;
}

std::vector<glm::vec3> baked(const prt::Transfer& raw, const prt::Light& light, Receivers receivers) {
    const prt::Light bands = prt::truncated(light, raw.order);
    std::vector<glm::vec3> radiance;
    for (const std::uint32_t receiver : receivers)
        radiance.push_back(prt::exit_radiance(raw.vector(receiver), raw.channels, bands));
    return radiance;
}

std::vector<glm::vec3> compressed(const prt::ClusteredTransfer& transfer, const prt::Light& light,
                                  Receivers receivers) {
    const std::vector<glm::vec3> all = prt::exit_radiance(transfer, light);
    std::vector<glm::vec3> radiance;
    for (const std::uint32_t receiver : receivers)
        radiance.push_back(all[receiver]);
    return radiance;
}

std::string key_of(const ExposureMeter::Subject& s) {
    const prt::Camera& c = s.camera;
    return fmt::format("{} {} {} {} {} {} {} {} {} {} {}", static_cast<const void*>(s.model), s.width,
                       s.height, s.textured, c.position.x, c.position.y, c.position.z, c.target.x, c.target.y,
                       c.target.z, c.vertical_field_of_view);
}

} // namespace

float ExposureMeter::exposure(const Subject& subject, const std::function<prt::Light()>& light) {
    std::string key = key_of(subject);
    if (key == seen_key_ && subject.radiance_version == radiance_version_)
        return exposure_;
    if (key != seen_key_) {
        prt::Picture picture;
        picture.scene = &subject.model->scene;
        picture.textures = subject.model->trace->textures();
        picture.camera = subject.camera;
        picture.width = subject.width;
        picture.height = subject.height;
        picture.textured = subject.textured;
        meter_.emplace(picture, subject.model->trace->rays());
        seen_key_ = std::move(key);
    }
    radiance_version_ = subject.radiance_version;
    const prt::Light all = light();
    const Receivers receivers = meter_->receivers();
    const std::vector<glm::vec3> radiance = subject.compressed
                                                ? compressed(*subject.compressed, all, receivers)
                                            : subject.raw ? baked(*subject.raw, all, receivers)
                                                          : unshadowed(subject.model->scene, all, receivers);
    const float luminance = meter_->luminance(radiance);
    exposure_ = luminance > 0 ? prt::exposure_for(luminance) : prt::automatic_exposure(all);
    return exposure_;
}

} // namespace viewer
