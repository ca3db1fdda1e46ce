#include "scene/small_objects.h"

#include "prt/ray_scene.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <limits>

namespace prt {
namespace {

constexpr float kResolvedOffsets = 128; ///< the least size of an object, in offsets of its rays

struct Box {
    glm::vec3 least{std::numeric_limits<float>::infinity()}, largest{-std::numeric_limits<float>::infinity()};

    void add(const glm::vec3& position) {
        least = glm::min(least, position);
        largest = glm::max(largest, position);
    }
    float size() const {
        const glm::vec3 extent = largest - least;
        return std::max({extent.x, extent.y, extent.z});
    }
    glm::vec3 farthest() const { return glm::max(glm::abs(least), glm::abs(largest)); }
};

Box box_of(const Scene& scene, const Primitive& primitive) {
    Box box;
    for (const glm::uvec3& t : primitive.triangles)
        for (int corner = 0; corner < 3; ++corner)
            box.add(scene.vertex_arrays[primitive.vertices].positions[t[corner]]);
    return box;
}

} // namespace

std::optional<std::string> small_object_notice(const Scene& scene) {
    std::size_t small = 0;
    float worst = kResolvedOffsets;
    std::string object;
    for (const Primitive& primitive : scene.primitives) {
        const Box box = box_of(scene, primitive);
        const float size = box.size();
        if (!(size > 0))
            continue; // no triangle, or all at one place
        const glm::vec3 farthest = box.farthest();
        const float offset = RayScene::coordinate_offset(farthest);
        if (!(size < kResolvedOffsets * offset))
            continue;
        ++small;
        if (size / offset < worst) {
            worst = size / offset;
            object = fmt::format(
                "{} is {:.2g} m in size and {:.0f} m from the middle of the scene, where rays "
                "start {:.2g} m off "
                "surfaces",
                primitive.node_name, size, std::max({farthest.x, farthest.y, farthest.z}), offset);
        }
    }
    if (small == 0)
        return std::nullopt;
    return fmt::format("{} too small for single precision so far out, their shadows are wrong by some 3 % or "
                       "more: {}; bake them in a smaller scene",
                       small == 1 ? "1 object is" : fmt::format("{} objects are", small), object);
}

} // namespace prt
