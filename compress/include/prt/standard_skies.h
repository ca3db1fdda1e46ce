#pragma once

// Lightings that are always at hand: what metrics of families are made of, and what errors are reported
// under. Grey, upright about +Y, their suns apart. Experimental.

#include "prt/transfer_layout.h"

#include <string>
#include <vector>

namespace prt {

/// A sky without clouds (prt/sky.h) over level ground, and its sun.
struct Daylight {
    double sun_elevation = 0; ///< radians, above 0 and below pi/2
    double turbidity = 2.5;   ///< 2 (clear) to 10 (haze)
};
/// The sun stands above +X, its light over that of sky and ground as in skies that were measured
/// (docs/math.md, section 4). Scaled so that sky and ground together have a mean radiance of 1.
Lighting daylight(int order, const Daylight& day);

/// The overcast sky of the CIE over the same ground, of mean radiance 1.
Lighting overcast_day(int order);

/// A room, brighter above than below, of mean radiance 1, and a lamp or window in it that stands as high as
/// it is said, radians, 16 degrees wide, in the place of a sun.
Lighting room_light(int order, double lamp_elevation);

struct NamedLighting {
    std::string name; ///< a word or two
    Lighting lighting;
};
/// Clear noon, a low sun, overcast, and a room with a window and a lamp.
std::vector<NamedLighting> standard_skies(int order);

} // namespace prt
