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

/// The transfer vector of one receiver.
std::vector<float> decoded(const prt::ClusteredTransfer& transfer, std::size_t receiver,
                           const std::vector<float>& weights) {
    const prt::ClusteredBases& bases = transfer.bases;
    const std::size_t cluster = transfer.receivers.clusters[receiver], guides = bases.guide_rows();
    std::vector<float> factors;
    for (std::size_t g = 0; g < guides; ++g)
        factors.push_back(bases.guide_scale(g) * transfer.receivers.guides[receiver * guides + g] -
                          static_cast<float>(bases.centers[cluster * guides + g]));
    factors.insert(factors.end(), weights.begin(), weights.end());
    const float* row = &bases.rows[bases.first_rows()[cluster] * bases.dimension()];
    std::vector<float> vector(row, row + bases.dimension());
    for (std::size_t j = 0; j < factors.size(); ++j)
        for (std::size_t i = 0; i < vector.size(); ++i)
            vector[i] += factors[j] * row[(1 + j) * bases.dimension() + i];
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
            first_channel(decoded(*compressed, *receiver, found.weights), compressed->bases.layout);
    }
    if (raw && (!compressed || prefer_raw)) {
        found.order = raw->layout.order;
        found.vector = first_channel(raw->vector(*receiver), raw->layout);
    }
    return found;
}

} // namespace viewer
