#pragma once

#include "prt/compress.h"

#include <cstddef>
#include <span>
#include <vector>

namespace prt {

/// Coordinates of the guides at all receivers, and what they are multiplied with to be weights.
struct GuideCoordinates {
    std::vector<Guide> guides;
    std::vector<float> values; ///< [receivers][count()], seen from the guides' origins

    std::size_t count() const { return 3 * guides.size(); }
    float& scale(std::size_t g) { return guides[g / 3].scale[static_cast<int>(g % 3)]; }
    float scaled(std::size_t receiver, std::size_t g) const {
        return values[receiver * count() + g] * guides[g / 3].scale[static_cast<int>(g % 3)];
    }
};

/// Those of `choice` that `surface` has and that differ between its receivers, scaled so that their
/// deviation over all receivers is about 1.
GuideCoordinates guide_coordinates(const ReceiverSurface& surface, GuideChoice choice);

} // namespace prt
