// A dance that changes the body's self-shadowing as much as possible.
#include "figure/dance.h"

#include "figure/movement.h"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace examples::anatomy {
namespace {

constexpr float kDancePeriod = 2; ///< seconds: 60 frames at 30 in a second
constexpr int kKeys = 60;
constexpr float kHipsHigh = 0.885f, kSecondDifference = 0.055f, kHipsAside = 0.09f; ///< metres
constexpr float kDancerFootAside = 0.13f;
constexpr float kKickHeight = 0.42f, kKickAhead = 0.46f; ///< metres, of the ankle

/// Returns 0, except in half of a cycle, in which it rises to 1 and falls back.
float beat(float phase) {
    const float rest = phase - std::floor(phase), up = rest < 0.5f ? 0.5f - 0.5f * wave(2 * rest) : 0;
    return up * up * (3 - 2 * up);
}

/// Moves an arm: at `lift` 0 it hangs, at 1 it is raised next to the head; at `across` 1 the forearm is in
/// front of the chest.
void raise_arm(Pose& pose, Side side, float lift, float across) {
    const auto arm = static_cast<std::size_t>(upper_arm(side));
    const float sign = sign_of(side);
    pose.rotations[arm] = rotation(sign * (-0.18f + 2.6f * lift), kZ) *
                          rotation(-1.05f * across - 0.35f * lift, kX) * rotation(-sign * 0.5f * across, kY);
    pose.rotations[arm + 1] = rotation(-0.35f - 1.55f * across, kX) * rotation(-sign * 0.35f * across, kZ);
    pose.rotations[arm + 2] = rotation(-0.2f * lift, kX);
}

/// `kick`: how far the leg is up.
FootPosition foot_at(float kick) {
    return {kAnkleHeight + kKickHeight * kick, kKickAhead * kick, -0.9f * kick, 0};
}

Pose dancing(float phase) {
    const float aside = wave(phase), step = wave(2 * phase);
    const float yaw = glm::radians(22.0f) * wave(phase - 0.25f), roll = glm::radians(-7.0f) * aside;
    Pose pose;
    pose.hips_position = {kHipsAside * aside, kHipsHigh - kSecondDifference * (0.5f + 0.5f * step), 0};
    pose.rotations[hips] = rotation(yaw, kY) * rotation(roll, kZ);
    pose.rotations[spine] =
        rotation(-1.6f * roll, kZ) * rotation(-0.7f * yaw, kY) * rotation(glm::radians(8.0f), kX);
    pose.rotations[chest] = rotation(-1.2f * yaw, kY) * rotation(-0.8f * roll, kZ);
    pose.rotations[neck] = rotation(0.5f * yaw, kY) * rotation(glm::radians(-5.0f), kX);
    pose.rotations[head] = rotation(0.4f * yaw, kY) * rotation(glm::radians(9.0f) * aside, kZ);
    for (const Side side : kSides) {
        const float own = phase + (side == Side::left ? 0.0f : 0.5f); // offset by half a cycle
        raise_arm(pose, side, beat(own + 0.1f), beat(own + 0.55f));
        place_foot(pose, side, foot_at(beat(own + 0.25f)), kDancerFootAside);
    }
    return pose;
}

} // namespace

Movement dance() {
    return movement_of("dance", dancing, kDancePeriod, kKeys);
}

} // namespace examples::anatomy
