#pragma once

// Predictor coordinates of receivers.

#include "prt/compress.h"

#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// Predictor coordinates of all receivers, and their scales as weights. Keeps references to the surface.
struct GuideCoordinates {
    std::vector<Guide> guides;
    std::vector<std::span<const glm::vec3>> attributes; ///< [guides][receivers], relative to their origins

    std::size_t count() const { return 3 * guides.size(); }
    float value(std::size_t receiver, std::size_t g) const {
        return attributes[g / 3][receiver][static_cast<int>(g % 3)];
    }
    float& scale(std::size_t g) { return guides[g / 3].scale[static_cast<int>(g % 3)]; }
    float scaled(std::size_t receiver, std::size_t g) const {
        return value(receiver, g) * guides[g / 3].scale[static_cast<int>(g % 3)];
    }
};

/// Returns the predictors of `choice` that `surface` has and that vary between its receivers, scaled so that
/// their standard deviation over all receivers is about 1.
GuideCoordinates guide_coordinates(const ReceiverSurface& surface, GuideChoice choice);

} // namespace prt
