// Finds the receiver under the pointer and decodes its transfer.

#include "core/hovered.h"

#include "core/texel_light.h"

#include "runtime/render/lightmap_lookup.h"

#include <algorithm>
#include <iterator>

namespace viewer {
namespace {

glm::vec3 shares_of(const prt::RayHit& hit) {
    return {1 - hit.uv.x - hit.uv.y, hit.uv};
}

std::uint32_t vertex_at(const Model& model, const prt::RayHit& hit) {
    const glm::uvec3& corners = model.trace->surfaces().corners(hit.triangle);
    const glm::vec3 w = shares_of(hit);
    return w.x >= w.y && w.x >= w.z ? corners.x : w.y >= w.z ? corners.y : corners.z;
}

/// Returns the texel with the largest filter weight.
std::uint32_t texel_at(const LoadedModel& loaded, const prt::RayHit& hit) {
    const prt::BilinearTexels filter =
        prt::LightmapLookup(loaded.model->scene, *loaded.lightmap.layout()).filter(hit.triangle, hit.uv);
    return filter.texels[std::ranges::max_element(filter.weights) - std::begin(filter.weights)];
}

glm::vec3 position_of(const prt::Scene& scene, std::uint32_t receiver) {
    for (const prt::VertexArray& vertices : scene.vertex_arrays)
        if (receiver >= vertices.first_receiver && receiver < vertices.first_receiver + vertices.size())
            return vertices.positions[receiver - vertices.first_receiver];
    return glm::vec3(0);
}

/// Returns the transfer vector of one receiver.
std::vector<float> decoded(const prt::ClusteredTransfer& transfer, std::size_t receiver,
                           const std::vector<float>& weights) {
    const prt::ClusteredBases& bases = transfer.bases;
    const std::size_t cluster = transfer.receivers.cluster(receiver), predictors = bases.predictor_rows();
    std::vector<float> factors;
    for (std::size_t g = 0; g < predictors; ++g)
        factors.push_back(bases.predictor_scale(g) *
                              transfer.receivers.predictors[receiver * predictors + g] -
                          static_cast<float>(bases.centers[cluster * predictors + g]));
    factors.insert(factors.end(), weights.begin(), weights.end());
    const float* row = &bases.rows[bases.first_rows()[cluster] * bases.dimension()];
    std::vector<float> vector(row, row + bases.dimension());
    for (std::size_t j = 0; j < factors.size(); ++j)
        for (std::size_t i = 0; i < vector.size(); ++i)
            vector[i] += factors[j] * row[(1 + j) * bases.dimension() + i];
    return vector;
}

/// Returns the combined transfer terms of the first channel.
std::vector<float> first_channel(std::span<const float> vector, const prt::TransferLayout& layout) {
    std::vector<float> whole = prt::as_combined(vector, layout);
    whole.resize(static_cast<std::size_t>(prt::coefficient_count(layout.order)));
    return whole;
}

/// Fills cluster, weights and vector from compressed transfer.
void take_compressed(const prt::ClusteredTransfer& compressed, Hovered& found) {
    found.cluster = static_cast<int>(compressed.receivers.cluster(found.receiver));
    const auto layouts = prt::cluster_layouts(compressed.bases);
    found.weights.resize(layouts[static_cast<std::size_t>(found.cluster)].components);
    prt::decode_weights(compressed, layouts, found.receiver, found.weights);
    found.order = compressed.bases.layout.order;
    found.vector = first_channel(decoded(compressed, found.receiver, found.weights), compressed.bases.layout);
}

} // namespace

std::optional<Hovered> find_hovered(const LoadedModel& loaded, bool prefer_raw, const Screen& screen,
                                    const glm::vec2& pixel) {
    const Model& model = *loaded.model;
    const prt::Ray ray{screen.camera.position, direction_through(screen, pixel)};
    const auto hit = model.trace->rays().nearest(ray);
    if (!hit)
        return std::nullopt;
    Hovered found;
    found.of = loaded.receivers();
    found.receiver = loaded.of_texels() ? texel_at(loaded, *hit) : vertex_at(model, *hit);
    found.position = loaded.of_texels() ? ray.origin + hit->distance * ray.direction
                                        : position_of(model.scene, found.receiver);
    if (loaded.compressed)
        take_compressed(*loaded.compressed, found);
    const std::optional<std::size_t> baked =
        !loaded.lightmap.baked ? found.receiver : receiver_of(loaded.lightmap.baked->texels, found.receiver);
    if (loaded.raw && baked && (!loaded.compressed || prefer_raw)) {
        found.order = loaded.raw->layout.order;
        found.vector = first_channel(loaded.raw->vector(*baked), loaded.raw->layout);
    }
    return found;
}

} // namespace viewer
