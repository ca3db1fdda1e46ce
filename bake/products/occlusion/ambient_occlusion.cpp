// Reads transfer of order 2: band 0 is the amount of arriving light, band 1 its direction.

#include "prt/bake/ambient_occlusion.h"

#include "bake/products/occlusion/occlusion_scene.h"
#include "prt/core/sh_basis.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace prt {

AmbientVisibility ambient_visibility_of(const Transfer& transfer, std::span<const glm::vec3> normals) {
    constexpr glm::vec3 kUp(0, 1, 0);
    AmbientVisibility ambient_visibility;
    for (std::size_t p = 0; p < transfer.receivers(); ++p) {
        const std::span<const float> t = transfer.vector(p);
        ambient_visibility.ambient.push_back(std::clamp(t[0] / static_cast<float>(kY00), 0.0f, 1.0f));
        const glm::vec3 towards(-t[3], -t[1], t[2]); // Y1-1 is -y, Y10 z, Y11 -x
        const float length = glm::length(towards);
        ambient_visibility.bent_normals.push_back(t[0] > 0 && length > 0 ? towards / length
                                                  : normals.empty()      ? kUp
                                                                         : normals[p]);
    }
    return ambient_visibility;
}

OcclusionResult ambient_occlusion(const Scene& scene, const OcclusionOptions& options,
                                  const Progress& progress, const FinerModel& finer) {
    BakeResult baked = bake(scene, bake_options(options), progress, MeasureErrors::no, finer);
    return {ambient_visibility_of(baked.baked.transfer, vertex_receivers(scene).normals),
            std::move(baked.statistics)};
}

} // namespace prt
