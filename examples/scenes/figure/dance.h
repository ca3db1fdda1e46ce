#pragma once

#include "skeleton.h"

namespace examples::anatomy {

/// Steps from side to side with kicks, arms up and across: two seconds that loop, on the spot.
Movement dance();

} // namespace examples::anatomy
