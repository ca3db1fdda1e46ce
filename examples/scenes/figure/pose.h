#pragma once

// A pose of the skeleton, and inverse kinematics for its legs.

#include "figure/bones.h"

#include <array>

namespace examples::anatomy {

struct Pose {
    glm::vec3 hips_position;                                 ///< metres
    std::array<glm::quat, bone_count> rotations = rotated(); ///< against the parent

private:
    static std::array<glm::quat, bone_count> rotated();
};

/// Position of a foot's ankle, metres, and rotations of the foot and its toes, radians.
struct FootPosition {
    float height, ahead; ///< position of the ankle
    float pitch;         ///< toes up
    float toe_bend;      ///< rotation of the toes relative to the foot, up
};

/// Returns the rotation about an axis by an angle in radians.
glm::quat rotation(float angle, const glm::vec3& axis);

/// Rotates thigh, shin, foot and toes of a side so that the foot is at `position`, `aside` metres from the
/// middle. The hips must be set before. Throws std::logic_error if the leg is too short.
void place_foot(Pose& pose, Side side, const FootPosition& position, float aside);

} // namespace examples::anatomy
