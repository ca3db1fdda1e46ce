#pragma once

// A bright spot of an image: its position, size and surrounding sky.

#include "runtime/fit/sky_map.h"

#include <optional>

namespace prt {

struct Spot {
    glm::dvec3 towards{0}; ///< unit, its center
    /// Radius of a disc with the solid angle of the region above half of the peak, radians.
    double radius = 0;
    double peak = 0;   ///< brightness
    double sky = 0;    ///< brightness of the surroundings
    double excess = 0; ///< brightness above the sky, integrated over the region above half of the peak
    double spread = 0; ///< root mean square distance of the excess from the center, radians
};

/// Returns the spot that contains `texel`; empty if it is wider than `widest`, elongated or fragmented, or
/// not brighter than its surroundings.
std::optional<Spot> spot_at(const SkyMap& map, std::size_t texel, double widest);

/// Region of the sky that is excluded from the search.
struct Taken {
    glm::dvec3 towards;
    double radius; ///< radians
};

/// Returns the spot with the largest light that the given order cannot represent, and whose disc does not
/// touch `taken`; empty if absent.
std::optional<Spot> strongest_spot(const SkyMap& map, double widest, std::span<const Taken> taken);

/// Extent of a spot with its halo, and the background color.
struct Aperture {
    double radius = 0; ///< radius about the center that contains its light, radians
    glm::dvec3 sky{0}; ///< the surrounding color
};

/// Grows the aperture from the disc of `spot` while the next ring contains significant light of the spot.
Aperture aperture_of(const SkyMap& map, const Spot& spot, double widest);

} // namespace prt
