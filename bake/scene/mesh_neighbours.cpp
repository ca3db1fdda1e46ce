// Finds which receivers hang together, across seams of the mesh.

#include "scene/mesh_neighbours.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace prt {
namespace {

/// For every receiver the first one with the same position and normal.
std::vector<std::uint32_t> places_of(const Receivers& receivers, std::size_t fronts) {
    const auto key = [&](std::uint32_t i) {
        const glm::vec3 &p = receivers.positions[i], &n = receivers.normals[i];
        return std::tuple(p.x, p.y, p.z, n.x, n.y, n.z);
    };
    std::vector<std::uint32_t> order(fronts), place(receivers.size());
    std::iota(order.begin(), order.end(), 0u);
    std::iota(place.begin(), place.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    for (std::size_t i = 1; i < order.size(); ++i)
        if (key(order[i]) == key(order[i - 1]))
            place[order[i]] = place[order[i - 1]];
    return place;
}

std::vector<Edge> edges_between(std::span<const std::uint32_t> place, const Surfaces& surfaces,
                                const std::vector<bool>& asked) {
    std::vector<bool> wanted(place.size(), asked.empty());
    for (std::size_t r = 0; r < asked.size(); ++r)
        if (asked[r])
            wanted[place[r]] = true;
    std::vector<Edge> edges;
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        const glm::uvec3& c = surfaces.corners(t);
        for (int i = 0; i < 3; ++i)
            if (const std::uint32_t a = place[c[i]], b = place[c[(i + 1) % 3]]; wanted[a] || wanted[b])
                edges.push_back({a, b});
    }
    return unique_edges(std::move(edges));
}

} // namespace

MeshNeighbours::MeshNeighbours(const Surfaces& surfaces, const Receivers& receivers, std::size_t fronts,
                               const std::vector<bool>& asked)
    : place_(places_of(receivers, fronts)),
      adjacency_(edges_between(place_, surfaces, asked), receivers.size()) {}

} // namespace prt
