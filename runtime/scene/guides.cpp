// Computes predictor coordinates from normals and positions of vertices.
#include "prt/guides.h"

namespace prt {

std::vector<float> guide_coordinates(const Scene& scene, std::span<const Guide> guides) {
    std::vector<float> coordinates;
    coordinates.reserve(scene.receivers() * 3 * guides.size());
    for (const VertexArray& vertices : scene.vertex_arrays)
        for (std::size_t v = 0; v < vertices.size(); ++v)
            for (const Guide& guide : guides) {
                const glm::vec3 x = guide.kind == GuideKind::normal ? vertices.normals[v]
                                                                    : vertices.positions[v] - guide.origin;
                coordinates.insert(coordinates.end(), {x.x, x.y, x.z});
            }
    return coordinates;
}

} // namespace prt
