#pragma once

// A bright spot of an image: where it is, how wide, and the sky around it.

#include "sky_map.h"

#include <optional>

namespace prt {

struct Spot {
    glm::dvec3 towards{0}; ///< unit, its middle
    double radius = 0;     ///< radians, of the disc that is as large as what is brighter than half its peak
    double peak = 0;       ///< brightness
    double sky = 0;        ///< brightness of what is around it
    double excess = 0;     ///< brightness over the sky, integrated over what is brighter than half its peak
    double spread = 0;     ///< radians, of that excess: the root of its mean squared distance from the middle
};

/// The spot on whose slope `texel` lies; nothing where it is wider than `widest`, long or in pieces, or
/// does not stand out.
std::optional<Spot> spot_at(const SkyMap& map, std::size_t texel, double widest);

/// A part of the sky where light is not looked for.
struct Taken {
    glm::dvec3 towards;
    double radius; ///< radians
};

/// The spot that weighs most for what a given order cannot hold, whose disc touches nothing of `taken`;
/// nothing where there is none.
std::optional<Spot> strongest_spot(const SkyMap& map, double widest, std::span<const Taken> taken);

/// What a spot and its halo stand on.
struct Aperture {
    double radius = 0; ///< radians about its middle, within which its light lies
    glm::dvec3 sky{0}; ///< the color around
};

/// Grows from the disc of `spot` for as long as what lies farther out has light that is its own.
Aperture aperture_of(const SkyMap& map, const Spot& spot, double widest);

} // namespace prt
