#pragma once

// The way of the sun over a day, as a light set. Experimental.

#include "prt/scene.h"

#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace prt {

struct SunArc {
    double latitude = 0;         ///< radians, north is positive
    int day = 172;               ///< of the year, 1..366; 172: the solstice of June
    glm::dvec3 north{0, 0, -1};  ///< of the scene, unit and level
    int keys = 12;               ///< 1 or more
    double half_angle = 0.00465; ///< radians, of the sun's disc
};

/// The sun's declination at noon of a day of the year, radians, to 0.4 degrees (P. I. Cooper, "The absorption
/// of radiation in solar stills", Solar Energy 12, 1969).
double declination(int day);

/// Towards the sun at an hour of true solar time, 12 where it is highest; unit, below the horizon by night.
glm::dvec3 towards_sun(const SunArc& arc, double hour);

/// Keys at even times from sunrise to sunset, both of them too, named "sun HH:MM" in true solar time, with
/// seconds where there are several a minute; a
/// single one at noon. Where the sun does not set they go from midnight to midnight. Throws `Error` where it
/// does not rise.
std::vector<PunctualLight> keys_of(const SunArc& arc);

} // namespace prt
