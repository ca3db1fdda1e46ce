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

std::vector<Edge> edges_between(std::span<const std::uint32_t> place, const Surfaces& surfaces) {
    std::vector<Edge> edges;
    edges.reserve(3 * surfaces.triangles());
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        const glm::uvec3& c = surfaces.corners(t);
        for (int i = 0; i < 3; ++i)
            edges.push_back({place[c[i]], place[c[(i + 1) % 3]]});
    }
    return unique_edges(std::move(edges));
}

} // namespace

MeshNeighbours::MeshNeighbours(const Surfaces& surfaces, const Receivers& receivers, std::size_t fronts)
    : place_(places_of(receivers, fronts)), adjacency_(edges_between(place_, surfaces), receivers.size()) {}

} // namespace prt
