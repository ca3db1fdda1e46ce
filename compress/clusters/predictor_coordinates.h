#pragma once

// Predictor coordinates of receivers.

#include "prt/compress/receiver_surface.h"
#include "prt/core/clustered_bases.h"

#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// Predictor coordinates of all receivers, and their scales as weights. Keeps references to the surface.
struct PredictorCoordinates {
    std::vector<Predictor> predictors;
    /// [predictors][receivers], relative to their origins.
    std::vector<std::span<const glm::vec3>> attributes;

    std::size_t count() const { return 3 * predictors.size(); }
    float value(std::size_t receiver, std::size_t g) const {
        return attributes[g / 3][receiver][static_cast<int>(g % 3)];
    }
    float& scale(std::size_t g) { return predictors[g / 3].scale[static_cast<int>(g % 3)]; }
    float scaled(std::size_t receiver, std::size_t g) const {
        return value(receiver, g) * predictors[g / 3].scale[static_cast<int>(g % 3)];
    }
};

/// Returns the predictors of `choice` that `surface` has and that vary between its receivers, scaled so that
/// their standard deviation over all receivers is about 1.
PredictorCoordinates predictor_coordinates(const ReceiverSurface& surface, PredictorChoice choice);

} // namespace prt
