#pragma once

// What lights of KHR_lights_punctual give without anything in their way.

#include "prt/scene.h"

#include <glm/vec3.hpp>

namespace prt {

/// Nothing is nearer to a point light than that, in metres: its inverse square has no end.
inline constexpr double kNearestToLight = 0.01;

/// Cosines of the angles from the middle of a spot where it is full, and where it ends; of other lights
/// below -1, where no direction is.
struct ConeCosines {
    double inner, outer;
};
ConeCosines cone_cosines(const PunctualLight& light);

/// Share of the light's intensity that goes along unit `along`, away from it: 1 but for a spot, whose cone
/// ends softly as the extension recommends.
double cone_share(const PunctualLight& light, const glm::dvec3& along);

/// What is left of an inverse square at `distance` metres where the light has a range: 1 - (d / range)^4,
/// nothing beyond, as the extension recommends.
double range_share(const PunctualLight& light, double distance);

} // namespace prt
