#pragma once

// Built-in lightings for the metrics of families and for error reports. They are grey and upright about +Y,
// and have separate suns. Experimental.

#include "prt/transfer_layout.h"

#include <vector>

namespace prt {

/// A clear sky (prt/sky.h) over horizontal ground, and its sun.
struct DaylightOptions {
    double sun_elevation = 0; ///< radians, between 0 and pi/2
    double turbidity = 2.5;   ///< 2 (clear) to 10 (haze)
};
/// Returns the lighting of a clear day. The sun is above +X; its intensity relative to sky and ground follows
/// measured skies (docs/math.md, section 4). Sky and ground together have a mean radiance of 1.
Lighting daylight(int order, const DaylightOptions& day);

/// Returns the CIE overcast sky over horizontal ground, with mean radiance 1.
Lighting overcast_day(int order);

/// Returns a room, brighter above than below, with mean radiance 1. A lamp or window of 16 degrees width at
/// elevation `lamp_elevation`, in radians, is stored as a separate sun.
Lighting room_light(int order, double lamp_elevation);

/// Returns clear noon, a low sun, overcast, and a room with a window and a lamp, with names.
std::vector<Lighting> standard_skies(int order);

} // namespace prt
