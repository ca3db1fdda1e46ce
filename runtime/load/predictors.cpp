// Computes predictor coordinates from normals and positions of vertices.
#include "runtime/load/predictors.h"

namespace prt {

std::vector<float> predictor_coordinates(const Scene& scene, std::span<const Predictor> predictors) {
    std::vector<float> coordinates;
    coordinates.reserve(scene.receivers() * 3 * predictors.size());
    for (const VertexArray& vertices : scene.vertex_arrays)
        for (std::size_t v = 0; v < vertices.size(); ++v)
            for (const Predictor& predictor : predictors) {
                const glm::vec3 x = predictor.kind == PredictorKind::normal
                                        ? vertices.normals[v]
                                        : vertices.positions[v] - predictor.origin;
                coordinates.insert(coordinates.end(), {x.x, x.y, x.z});
            }
    return coordinates;
}

} // namespace prt
