#pragma once

// Suns by the keys of a light set: hard shadows of a day without a shadow map. Experimental.

#include "prt/sun_disc.h"
#include "prt/transfer_layout.h"

#include <glm/vec3.hpp>

#include <span>

namespace prt {

/// Whether lamps of the layout are keys of a light set.
bool has_light_set(const TransferLayout& layout);

/// Adds `sun` to `strengths` [layout.lamps()]: its irradiance, on the key that it stands at, or on the two
/// neighbours between which it stands. They are weighted so that what both light has the irradiance of the
/// sun itself, whatever its normal (K. Shoemake, "Animating Rotation with Quaternion Curves", SIGGRAPH 1985,
/// on arcs). Keys are neighbours as they follow each other in the layout, where
/// they stand a right angle apart at most. Returns the angle from the sun to the nearest
/// place of the set, radians: where it is more than a few degrees the light comes from elsewhere. Throws
/// `Error` where the layout has no light set. Allocates nothing.
double add_sun(const TransferLayout& layout, const SunDisc& sun, std::span<glm::vec3> strengths);

} // namespace prt
