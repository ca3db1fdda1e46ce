// Finds objects that are too small for the offset of their rays.

#include "bake/scene/small_objects.h"

#include "bake/scene/ray_scene.h"
#include "runtime/core/support/counted.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>

namespace prt {
namespace {

constexpr float kResolvedOffsets = 128; ///< minimum size of an object, in offsets of its rays

float largest(const glm::vec3& v) {
    return std::max({v.x, v.y, v.z});
}

} // namespace

std::optional<std::string> small_object_notice(const Scene& scene) {
    std::size_t small = 0;
    float worst = kResolvedOffsets;
    std::string object;
    for (const Primitive& primitive : scene.primitives) {
        const Bounds box = bounds(scene, primitive);
        const float size = largest(box.high - box.low);
        if (!(size > 0))
            continue; // no triangle, or all at one position
        const glm::vec3 farthest = glm::max(glm::abs(box.low), glm::abs(box.high));
        const float offset = RayScene::coordinate_offset(farthest);
        if (!(size < kResolvedOffsets * offset))
            continue;
        ++small;
        if (size / offset < worst) {
            worst = size / offset;
            object =
                fmt::format("{} has a size of {:.2g} m and is {:.0f} m from the center of the scene, where "
                            "rays start {:.2g} m from surfaces",
                            primitive.node_name, size, largest(farthest), offset);
        }
    }
    if (small == 0)
        return std::nullopt;
    return fmt::format(
        "{} too small for single precision at this distance from the center; shadows have an error of "
        "about 3 % or more: {}; bake small objects in a smaller scene",
        counted(small, "object is", "objects are"), object);
}

} // namespace prt
