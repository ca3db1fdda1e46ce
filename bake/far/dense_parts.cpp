// Measures nodes.

#include "far/dense_parts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <map>

namespace prt {
namespace {

/// Fewer are traced as quickly as voxels are crossed.
constexpr std::size_t kLeastTriangles = 64;
/// Of the distance. What is flatter is a wall, which voxels would let light through.
constexpr float kLeastWidth = 1.0f / 16;

struct Extent {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
    std::size_t triangles = 0;

    void add(const glm::vec3& position) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
};

std::map<int, Extent> extents_of_nodes(const Scene& scene) {
    std::map<int, Extent> nodes;
    for (const Primitive& primitive : scene.primitives) {
        if (!scene.materials[primitive.material].casts_shadow)
            continue;
        Extent& node = nodes[primitive.node];
        node.triangles += primitive.triangles.size();
        const std::vector<glm::vec3>& positions = scene.vertex_arrays[primitive.vertices].positions;
        for (const glm::uvec3& triangle : primitive.triangles)
            for (int corner = 0; corner < 3; ++corner)
                node.add(positions[triangle[corner]]);
    }
    return nodes;
}

} // namespace

DenseParts find_dense_parts(const Scene& scene, float distance) {
    const std::map<int, Extent> nodes = extents_of_nodes(scene);
    DenseParts dense;
    Extent all;
    const auto is_dense = [&](const Extent& node) {
        const glm::vec3 sides = node.high - node.low;
        return node.triangles >= kLeastTriangles && glm::length(sides) <= distance &&
               std::min({sides.x, sides.y, sides.z}) > kLeastWidth * distance;
    };
    for (const auto& [index, node] : nodes)
        if (is_dense(node)) {
            dense.nodes.push_back({node.low, node.high});
            dense.triangles += node.triangles;
            all.add(node.low);
            all.add(node.high);
        }
    for (const Primitive& primitive : scene.primitives) {
        const auto node = nodes.find(primitive.node);
        dense.primitives.push_back(scene.materials[primitive.material].casts_shadow && node != nodes.end() &&
                                   is_dense(node->second));
    }
    if (!dense.nodes.empty())
        dense.all = {all.low, all.high};
    return dense;
}

} // namespace prt
