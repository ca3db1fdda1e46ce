#pragma once

#include "skeleton.h"

namespace examples::anatomy {

/// Returns a looping walk with a fixed root: the ground passes below.
Movement walk();
/// Standing, breathing.
Movement idle();

} // namespace examples::anatomy
