// Computes predictor coordinates: normals and positions, scaled by their standard deviation.

#include "compress/clusters/predictor_coordinates.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// Returns the root mean square distance of all values from their mean.
double extent(std::span<const glm::vec3> values) {
    glm::dvec3 sum(0);
    for (const glm::vec3& v : values)
        sum += glm::dvec3(v);
    const glm::dvec3 mean = sum / static_cast<double>(std::max<std::size_t>(values.size(), 1));
    double squares = 0;
    for (const glm::vec3& v : values)
        squares += glm::dot(glm::dvec3(v) - mean, glm::dvec3(v) - mean);
    return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
}

} // namespace

PredictorCoordinates predictor_coordinates(const ReceiverSurface& surface, PredictorChoice choice) {
    PredictorCoordinates result;
    const auto add = [&](PredictorKind kind, std::span<const glm::vec3> values) {
        const double size = extent(values);
        const auto scale = static_cast<float>(1 / size);
        if (!(size > 0) || !std::isfinite(scale))
            return;
        result.predictors.push_back({kind, glm::vec3(0), glm::vec3(scale)});
        result.attributes.push_back(values);
    };
    if (choice != PredictorChoice::none)
        add(PredictorKind::normal, surface.normals);
    if (choice == PredictorChoice::normal_and_position)
        add(PredictorKind::position, surface.positions);
    return result;
}

} // namespace prt
