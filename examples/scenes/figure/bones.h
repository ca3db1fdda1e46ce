#pragma once

// The joints of the figure and their rest positions: a standing person with the arms slightly away from the
// body.

#include "skeleton.h"

#include <array>

namespace examples::anatomy {

enum Bone : int {
    hips,
    spine,
    chest,
    neck,
    head,
    left_upper_arm,
    left_forearm,
    left_hand,
    right_upper_arm,
    right_forearm,
    right_hand,
    left_thigh,
    left_shin,
    left_foot,
    left_toes,
    right_thigh,
    right_shin,
    right_foot,
    right_toes,
    bone_count
};

/// Left is +X for a person who looks along +Z.
enum class Side { left, right };
inline constexpr std::array kSides = {Side::left, Side::right};

/// +1 on the left.
constexpr float sign_of(Side side) {
    return side == Side::left ? 1.0f : -1.0f;
}

/// Returns the first joint of an arm or a leg; the next indices continue it.
constexpr int upper_arm(Side side) {
    return side == Side::left ? left_upper_arm : right_upper_arm;
}
constexpr int thigh(Side side) {
    return side == Side::left ? left_thigh : right_thigh;
}

inline constexpr float kUpperArm = 0.29f, kForearm = 0.26f; ///< lengths, metres
inline constexpr float kThigh = 0.42f, kShin = 0.415f;      ///< lengths, metres
inline constexpr float kAnkleHeight = 0.085f;               ///< above the sole
/// position of the toe joint, relative to the point below the ankle
inline constexpr float kBallAhead = 0.12f, kBallHeight = 0.025f;
inline constexpr float kHeelBehind = 0.065f;

/// Unit, from the shoulder to the hand at rest.
glm::vec3 arm_direction(Side side);

/// The joints in the order of `Bone`.
std::vector<Joint> joints();

} // namespace examples::anatomy
