// Computes predictor coordinates from normals and positions of vertices.
#include "runtime/load/predictors.h"

#include "prt/core/error.h"

#include <cmath>

namespace prt {
namespace {

glm::vec3 coordinate(const Predictor& predictor, const VertexArray& vertices, std::size_t vertex) {
    return predictor.kind == PredictorKind::normal ? vertices.normals[vertex]
                                                   : vertices.positions[vertex] - predictor.origin;
}

} // namespace

std::vector<float> predictor_coordinates(const Scene& scene, std::span<const Predictor> predictors) {
    std::vector<float> coordinates;
    coordinates.reserve(scene.receivers() * 3 * predictors.size());
    for (const VertexArray& vertices : scene.vertex_arrays)
        for (std::size_t v = 0; v < vertices.size(); ++v)
            for (const Predictor& predictor : predictors) {
                const glm::vec3 x = coordinate(predictor, vertices, v);
                coordinates.insert(coordinates.end(), {x.x, x.y, x.z});
            }
    return coordinates;
}

void check_predictors(const Scene& scene, std::span<const Predictor> predictors) {
    const auto check = [](const glm::vec3& x, const glm::vec3& scale) {
        for (int i = 0; i < 3; ++i)
            if (!(std::abs(x[i] * scale[i]) <= kMaxFloatWeight))
                throw Error("a vertex is farther from the origin of a predictor than its scale allows");
    };
    for (const Predictor& predictor : predictors)
        for (const VertexArray& vertices : scene.vertex_arrays)
            for (std::size_t v = 0; v < vertices.size(); ++v)
                check(coordinate(predictor, vertices, v), predictor.scale);
}

} // namespace prt
