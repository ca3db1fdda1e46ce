// Finds receivers that are connected, across duplicated vertices of the mesh.

#include "bake/scene/mesh_neighbours.h"

#include "bake/scene/alike_receivers.h"

namespace prt {
namespace {

std::vector<Edge> edges_between(std::span<const std::uint32_t> position, const Surfaces& surfaces,
                                const std::vector<bool>& asked) {
    std::vector<bool> wanted(position.size(), asked.empty());
    for (std::size_t r = 0; r < asked.size(); ++r)
        if (asked[r])
            wanted[position[r]] = true;
    std::vector<Edge> edges;
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        const glm::uvec3& c = surfaces.corners(t);
        for (int i = 0; i < 3; ++i)
            if (const std::uint32_t a = position[c[i]], b = position[c[(i + 1) % 3]]; wanted[a] || wanted[b])
                edges.push_back({a, b});
    }
    return unique_edges(std::move(edges));
}

} // namespace

MeshNeighbours::MeshNeighbours(const Surfaces& surfaces, const Receivers& receivers, std::size_t fronts,
                               const std::vector<bool>& asked)
    : position_(alike_receivers(surfaces, receivers, fronts)),
      adjacency_(edges_between(position_, surfaces, asked), receivers.size()) {}

} // namespace prt
