#pragma once

// Light of KHR_lights_punctual without occlusion.

#include "prt/load/scene.h"

#include <glm/vec3.hpp>

namespace prt {

/// Minimum distance to a point light in metres, because the inverse square is unbounded.
inline constexpr double kNearestToLight = 0.01;

/// Cosines of the angles from the axis of a spot at which its light starts to decrease and at which it ends;
/// below -1 for other lights, so that every direction is inside.
struct ConeCosines {
    double inner, outer;
};
ConeCosines cone_cosines(const PunctualLight& light);

/// Share of the light's intensity along unit `along`, away from the light: 1 except for a spot, whose cone
/// ends softly as recommended by the extension.
double cone_share(const PunctualLight& light, const glm::dvec3& along);

/// Attenuation in addition to the inverse square at `distance` metres if the light has a range: 1 - (d /
/// range)^4, zero beyond, as recommended by the extension.
double range_share(const PunctualLight& light, double distance);

} // namespace prt
