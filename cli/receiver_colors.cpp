#include "receiver_colors.h"

#include "prt/error.h"
#include "prt/error_measures.h"
#include "prt/sh.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace prt::cli {
namespace {

/// Transfer of receivers that nothing shadows.
Transfer unshadowed_transfer(const Scene& scene, int order) {
    Transfer transfer{order, 1, {}};
    std::array<double, kMaxOrder * kMaxOrder> lobe{};
    for (const VertexArray& vertices : scene.vertex_arrays)
        for (const glm::vec3& normal : vertices.normals) {
            clamped_cosine_lobe(order, glm::dvec3(normal), lobe);
            for (std::size_t i = 0; i < transfer.dimension(); ++i)
                transfer.vectors.push_back(normal == glm::vec3(0) ? 0.0f : static_cast<float>(lobe[i]));
        }
    return transfer;
}

} // namespace

std::vector<glm::vec3> lit_colors(const Model& model, const Light& light, int threads) {
    if (model.compressed)
        return exit_radiance(model.compressed->transfer, light, threads);
    if (model.baked)
        return exit_radiance(model.baked->transfer, light, threads);
    return exit_radiance(unshadowed_transfer(model.scene, light.order), light, threads);
}

std::vector<glm::vec3> ao_colors(const Model& model, int threads) {
    return lit_colors(model, constant_light(std::max(1, model.order()), glm::vec3(1)), threads);
}

std::vector<glm::vec3> cluster_colors(const Model& model) {
    if (!model.compressed)
        throw Error("--show clusters needs a compressed file");
    std::vector<glm::vec3> colors;
    for (const std::uint16_t cluster : model.compressed->transfer.receivers.clusters) {
        // Hues a golden ratio apart: neighbours in number differ, and no two of many are the same.
        const double hue = 6 * std::fmod(0.61803398875 * cluster, 1.0);
        const double value = 0.45 + 0.5 * std::fmod(0.754877666 * cluster, 1.0);
        glm::dvec3 color;
        for (int c = 0; c < 3; ++c)
            color[c] = value * std::clamp(std::abs(std::fmod(hue + 2 * c, 6.0) - 3) - 1, 0.08, 1.0);
        colors.emplace_back(color);
    }
    return colors;
}

std::vector<glm::vec3> error_colors(const Model& model, const Model& baked, const Light& light, int threads) {
    const std::vector<float> areas = receiver_areas(baked.scene);
    const std::vector<glm::vec3> reference = exit_radiance(baked.baked->transfer, light, threads);
    const std::vector<glm::vec3> approximation = lit_colors(model, light, threads);
    const double mean = lit_error(reference, approximation, areas, {}, std::nullopt).mean;
    std::vector<glm::vec3> colors;
    for (std::size_t p = 0; p < reference.size(); ++p) {
        const glm::vec3 d = glm::abs(reference[p] - approximation[p]);
        const double error =
            mean > 0 ? static_cast<double>(std::max({d.r, d.g, d.b})) / (mean * kWhiteError) : 0;
        const auto ramp = static_cast<float>(3 * std::min(error, 1.0));
        colors.emplace_back(glm::clamp(glm::vec3(ramp, ramp - 1, ramp - 2), 0.0f, 1.0f));
    }
    return colors;
}

} // namespace prt::cli
