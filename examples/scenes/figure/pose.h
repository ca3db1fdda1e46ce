#pragma once

// A pose of the skeleton, and legs that reach for where their feet shall be.

#include "figure/bones.h"

#include <array>

namespace examples::anatomy {

struct Pose {
    glm::vec3 hips_position;                                ///< metres
    std::array<glm::quat, bone_count> rotations = turned(); ///< against the parent

private:
    static std::array<glm::quat, bone_count> turned();
};

/// Where a foot is: its ankle, metres, and how far it and its toes are turned, radians.
struct FootPlace {
    float height, ahead; ///< of the ankle
    float pitch;         ///< toes up
    float toe_bend;      ///< of the toes against the foot, up
};

/// A turn about an axis by radians.
glm::quat turn(float angle, const glm::vec3& axis);

/// Turns thigh, shin, foot and toes of a side so that the foot is at `place`, `aside` metres from the middle.
/// The hips are set before. Throws std::logic_error where the leg is too short.
void place_foot(Pose& pose, Side side, const FootPlace& place, float aside);

} // namespace examples::anatomy
