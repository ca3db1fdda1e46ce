#pragma once

// Built-in lightings for the metrics of families and for error reports. They are grey, have +Y up and include
// no lamps of a scene. `order`: number of SH bands, 1..kMaxOrder; all functions throw `Error` for other
// orders. Experimental.

#include "prt/core/transfer_layout.h"

#include <vector>

namespace prt {

/// A clear sky (prt/core/light.h) over horizontal ground of albedo 0.2, and its sun.
struct DaylightOptions {
    double sun_elevation = 0; ///< radians above the horizon, 0..pi/2; at 0 there is no sunlight
    double turbidity = 2.5;   ///< haziness of the air, 1.7..10: 2 is clear, 10 is hazy
};
/// Returns the lighting of a clear day, with the sun as separate light in `Lighting::suns`, which has no
/// value if the elevation is 0. The sun is above the direction +X. Its intensity relative to sky and ground
/// follows measured skies (docs/math.md, section 4). `Lighting::sky`, which includes light reflected by the
/// ground, has a mean radiance of 1 over all directions. Throws `Error` if the turbidity is out of range or
/// the sun is below the horizon.
Lighting daylight(int order, const DaylightOptions& day);

/// Returns the CIE overcast sky over horizontal ground of albedo 0.2, without a sun. The mean radiance over
/// all directions is 1.
Lighting overcast_day(int order);

/// Returns the lighting of a room. `Lighting::sky` is brighter above than below, with a mean radiance of 1
/// over all directions. A lamp or window, a disc of 16 degrees diameter, is in `Lighting::suns`. Its center
/// is `lamp_elevation` radians above the direction +X.
Lighting room_light(int order, double lamp_elevation);

/// Returns four lightings with names: "clear noon" and "low sun" (with separate suns), "overcast", and
/// "window and lamp" (a room, all in `Lighting::sky`).
std::vector<Lighting> standard_skies(int order);

} // namespace prt
