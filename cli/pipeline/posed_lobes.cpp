// Sums the lobes of vertices to transfer vectors.

#include "cli/pipeline/posed_lobes.h"

#include <array>

namespace prt::pipeline {

void lobe_transfer_in_pose(const LobeModel& lobes, const VertexFrames& frames, std::size_t vertex, int order,
                           std::span<float> transfer) {
    std::array<Lobe, kMaxLobes> of_vertex;
    lobes.decode(vertex, of_vertex);
    for (Lobe& lobe : of_vertex)
        lobe.axis = rotated_axis(lobe.axis, axis_rotation(glm::mat3(frames.matrix(vertex))));
    lobe_transfer(of_vertex, order, transfer);
}

BakedTransfer lobes_as_transfer(const SceneFile& model) {
    const StoredLobes& stored = model.lobes.value();
    const AnimatedScene animated(model.document);
    const VertexFrames frames(animated, {"", 0, animated.rest()});
    const int order = stored.model.order;
    BakedTransfer result{zero_transfer(order, 1, frames.vertices()), {}};
    result.record.bounces = stored.record.bounces;
    result.record.rays = stored.record.rays;
    result.record.seed = stored.record.seed;
    for (std::size_t v = 0; v < frames.vertices(); ++v)
        lobe_transfer_in_pose(stored.model, frames, v, order, result.transfer.vector(v));
    return result;
}

} // namespace prt::pipeline
