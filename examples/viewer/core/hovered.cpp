#include "core/hovered.h"

namespace viewer {
namespace {

std::optional<std::uint32_t> receiver_at(const Model& model, const Screen& screen, const glm::vec2& pixel) {
    const auto hit = model.trace->rays().nearest({screen.camera.position, direction_through(screen, pixel)});
    if (!hit)
        return std::nullopt;
    const glm::uvec3& corners = model.trace->surfaces().corners(hit->triangle);
    const float u = hit->uv.x, v = hit->uv.y, w = 1 - u - v;
    return w >= u && w >= v ? corners.x : u >= v ? corners.y : corners.z;
}

glm::vec3 position_of(const prt::Scene& scene, std::uint32_t receiver) {
    for (const prt::VertexArray& vertices : scene.vertex_arrays)
        if (receiver >= vertices.first_receiver && receiver < vertices.first_receiver + vertices.size())
            return vertices.positions[receiver - vertices.first_receiver];
    return glm::vec3(0);
}

/// mean + sum_j w_j direction_j.
std::vector<float> decoded(const prt::ClusteredBases& bases, std::size_t cluster,
                           const std::vector<float>& weights) {
    const float* row = &bases.rows[bases.first_rows()[cluster] * bases.dimension()];
    std::vector<float> vector(row, row + bases.dimension());
    for (std::size_t j = 0; j < weights.size(); ++j)
        for (std::size_t i = 0; i < vector.size(); ++i)
            vector[i] += weights[j] * row[(1 + j) * bases.dimension() + i];
    return vector;
}

/// All light of the first channel.
std::vector<float> first_channel(std::span<const float> vector, const prt::TransferLayout& layout) {
    std::vector<float> whole = prt::as_whole(vector, layout);
    whole.resize(static_cast<std::size_t>(prt::coefficient_count(layout.order)));
    return whole;
}

} // namespace

std::optional<Hovered> find_hovered(const Model& model, const prt::Transfer* raw,
                                    const prt::ClusteredTransfer* compressed, bool prefer_raw,
                                    const Screen& screen, const glm::vec2& pixel) {
    const auto receiver = receiver_at(model, screen, pixel);
    if (!receiver)
        return std::nullopt;
    Hovered found;
    found.receiver = *receiver;
    found.position = position_of(model.scene, *receiver);
    if (compressed) {
        found.cluster = compressed->receivers.clusters[*receiver];
        const auto layouts = prt::cluster_layouts(compressed->bases);
        found.weights.resize(layouts[static_cast<std::size_t>(found.cluster)].components);
        prt::decode_weights(*compressed, layouts, *receiver, found.weights);
        found.order = compressed->bases.layout.order;
        found.vector =
            first_channel(decoded(compressed->bases, static_cast<std::size_t>(found.cluster), found.weights),
                          compressed->bases.layout);
    }
    if (raw && (!compressed || prefer_raw)) {
        found.order = raw->layout.order;
        found.vector = first_channel(raw->vector(*receiver), raw->layout);
    }
    return found;
}

} // namespace viewer
