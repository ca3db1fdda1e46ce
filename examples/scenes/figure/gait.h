#pragma once

#include "skeleton.h"

namespace examples::anatomy {

/// A walk that loops, its root in place: the ground passes below.
Movement walk();
/// Standing, breathing.
Movement idle();

} // namespace examples::anatomy
