// Finds vertices that were split for texture coordinates or materials.

#include "scene/alike_receivers.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace prt {
namespace {

/// Node of each receiver at a corner, [receivers]; -1: of none.
std::vector<int> nodes_of(const Surfaces& surfaces, std::size_t receivers,
                          std::span<const std::uint32_t> back) {
    std::vector<int> nodes(receivers, -1);
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        const int node = surfaces.scene().primitives[surfaces.primitive(t)].node;
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t front = surfaces.corners(t)[corner];
            nodes[front] = node;
            if (!back.empty() && back[front] < receivers)
                nodes[back[front]] = node;
        }
    }
    return nodes;
}

} // namespace

std::vector<std::uint32_t> alike_receivers(const Surfaces& surfaces, const Receivers& receivers,
                                           std::size_t fronts, std::span<const std::uint32_t> back) {
    const std::vector<int> nodes = nodes_of(surfaces, receivers.size(), back);
    const auto key = [&](std::uint32_t p) {
        const glm::vec3 &at = receivers.positions[p], &n = receivers.normals[p];
        return std::tuple(nodes[p], p >= fronts, at.x, at.y, at.z, n.x, n.y, n.z);
    };
    std::vector<std::uint32_t> order, first(receivers.size());
    std::iota(first.begin(), first.end(), 0u);
    for (std::uint32_t p = 0; p < receivers.size(); ++p)
        if (nodes[p] >= 0)
            order.push_back(p);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    for (std::size_t i = 1; i < order.size(); ++i)
        if (key(order[i]) == key(order[i - 1]))
            first[order[i]] = first[order[i - 1]];
    return first;
}

} // namespace prt
