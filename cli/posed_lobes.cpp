#include "posed_lobes.h"

#include "prt/pose_bake.h"

#include <array>

namespace prt::cli {

BakedTransfer lobes_as_transfer(const SceneFile& model) {
    const StoredLobes& stored = model.lobes.value();
    const AnimatedScene animated(model.document);
    const VertexFrames frames(animated, {"", 0, animated.rest()});
    const int order = stored.model.order;
    BakedTransfer result{zero_transfer(order, 1, frames.vertices()), {}};
    result.record.bounces = stored.record.bounces;
    result.record.rays = stored.record.rays;
    result.record.seed = stored.record.seed;
    std::array<Lobe, kMostLobes> lobes;
    for (std::size_t v = 0; v < frames.vertices(); ++v) {
        stored.model.decode(v, lobes);
        for (Lobe& lobe : lobes)
            lobe.axis = turned_axis(lobe.axis, axis_turn(glm::mat3(frames.matrix(v))));
        lobe_transfer(lobes, order, result.transfer.vector(v));
    }
    return result;
}

} // namespace prt::cli
