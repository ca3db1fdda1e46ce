#include "prt/mesh_edges.h"

#include <algorithm>

namespace prt {

std::vector<Edge> mesh_edges(const Scene& scene) {
    std::vector<Edge> edges;
    edges.reserve(3 * scene.triangles());
    for (const Primitive& primitive : scene.primitives) {
        const auto first = static_cast<std::uint32_t>(scene.vertex_arrays[primitive.vertices].first_receiver);
        for (const glm::uvec3& t : primitive.triangles)
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t a = first + t[corner], b = first + t[(corner + 1) % 3];
                if (a != b)
                    edges.push_back({std::min(a, b), std::max(a, b)});
            }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

} // namespace prt
