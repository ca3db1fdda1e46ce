#pragma once

// Converts the poses of a cycle to a looping movement.

#include "figure/pose.h"

#include <string>

namespace examples::anatomy {

inline constexpr glm::vec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

/// A cosine of period 1.
float wave(float phase);

/// Returns `keys` + 1 keys of a cycle of `period` seconds; `pose_at` takes phases from 0 to 1, and the last
/// key equals the first.
Movement movement_of(std::string name, Pose (*pose_at)(float phase), float period, int keys);

} // namespace examples::anatomy
