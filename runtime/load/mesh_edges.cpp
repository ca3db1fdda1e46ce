// Collects the edges of a scene's triangles.
#include "runtime/load/mesh_edges.h"

namespace prt {

std::vector<Edge> mesh_edges(const Scene& scene) {
    std::vector<Edge> edges;
    edges.reserve(3 * scene.triangles());
    for (const Primitive& primitive : scene.primitives) {
        const auto first = static_cast<std::uint32_t>(scene.vertex_arrays[primitive.vertices].first_receiver);
        for (const glm::uvec3& t : primitive.triangles)
            for (int corner = 0; corner < 3; ++corner)
                edges.push_back({first + t[corner], first + t[(corner + 1) % 3]});
    }
    return unique_edges(std::move(edges));
}

} // namespace prt
