// Converts vertices to receivers, and computes their transfer without shadows.

#include "bake/scene/receivers.h"

#include "bake/scene/ray_starts.h"
#include "prt/core/sh.h"

#include <array>

namespace prt {

void Receivers::append(const Receivers& from, std::size_t index) {
    positions.push_back(from.positions[index]);
    normals.push_back(from.normals[index]);
    areas.push_back(from.areas[index]);
    if (!from.starts.empty())
        starts.push_back(from.starts[index]);
}

Receivers vertex_receivers(const Scene& scene) {
    Receivers receivers;
    for (const VertexArray& vertices : scene.vertex_arrays) {
        receivers.positions.insert(receivers.positions.end(), vertices.positions.begin(),
                                   vertices.positions.end());
        receivers.normals.insert(receivers.normals.end(), vertices.normals.begin(), vertices.normals.end());
    }
    receivers.areas = receiver_areas(scene);
    receivers.starts = ray_starts(scene, Side::front);
    return receivers;
}

std::vector<std::uint32_t> receivers_on_surfaces(const Receivers& receivers) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < receivers.size(); ++i)
        if (receivers.areas[i] > 0 && receivers.normals[i] != glm::vec3(0))
            indices.push_back(i);
    return indices;
}

Transfer unshadowed_transfer(const Scene& scene, int order) {
    Transfer transfer{layout_of_one(order, 1, TermKind::direct), {}};
    std::array<double, kMaxOrder * kMaxOrder> lobe{};
    for (const VertexArray& vertices : scene.vertex_arrays)
        for (const glm::vec3& normal : vertices.normals) {
            clamped_cosine_lobe(order, glm::dvec3(normal), lobe);
            for (std::size_t i = 0; i < transfer.dimension(); ++i)
                transfer.vectors.push_back(normal == glm::vec3(0) ? 0.0f : static_cast<float>(lobe[i]));
        }
    return transfer;
}

} // namespace prt
