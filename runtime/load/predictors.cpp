// Computes predictor coordinates from normals and positions of vertices.
#include "runtime/load/predictors.h"

#include "prt/core/error.h"

#include <cmath>

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

std::vector<float> checked_coordinates(const Scene& scene, const ClusteredBases& bases) {
    if (bases.predictors.empty())
        return {};
    std::vector<float> coordinates = predictor_coordinates(scene, bases.predictors);
    for (std::size_t i = 0; i < coordinates.size(); ++i)
        if (!(std::abs(coordinates[i] * bases.predictor_scale(i % bases.predictor_rows())) <=
              kMaxFloatWeight))
            throw Error("a vertex is farther from the origin of a predictor than its scale allows");
    return coordinates;
}

} // namespace prt
