// A human walk: a foot is on the ground for 60 % of a cycle, heel first and toes last; hips are highest while
// one leg is straight below them, and rotate with the legs; arms swing against them (Perry and Burnfield,
// Gait Analysis, 2010).
#include "figure/gait.h"

#include "figure/movement.h"

#include <glm/trigonometric.hpp>

#include <cmath>

namespace examples::anatomy {
namespace {

constexpr float kSpeed = 1.15f; ///< metres per second
constexpr float kPeriod = 1.1f; ///< seconds, for two steps
constexpr float kStance = 0.6f; ///< fraction of the cycle, from heel strike to toe off
constexpr float kStride = kSpeed * kPeriod;
constexpr float kStepAhead = 0.315f; ///< metres, of the flat foot's ankle before the hips as the heel strikes
constexpr float kStrikePitch = 0.31f, kOffPitch = -0.84f; ///< radians
constexpr float kFlatFrom = 0.10f, kFlatTo = 0.32f;       ///< range of the cycle with the whole sole on the
                                                          ///< ground
constexpr float kHipsHeight = 0.914f, kBob = 0.014f, kSway = 0.018f; ///< metres
constexpr float kLift = 0.025f; ///< metres, of the foot in the air, so that its toes do not drag
constexpr float kFootAside = 0.082f;
constexpr int kWalkKeys = 40, kIdleKeys = 16;
constexpr float kIdlePeriod = 4;

/// From (0, a) to (1, b) with slopes `da` and `db`.
float hermite(float a, float da, float b, float db, float t) {
    const float t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * da + (3 * t2 - 2 * t3) * b + (t3 - t2) * db;
}

/// Returns the pitch of the foot on the ground, toes up.
float stance_pitch(float phase) {
    if (phase < kFlatFrom)
        return hermite(kStrikePitch, -0.8f * kStrikePitch, 0, 0, phase / kFlatFrom);
    if (phase <= kFlatTo)
        return 0;
    return hermite(0, 0, kOffPitch, 0.75f * kOffPitch, (phase - kFlatTo) / (kStance - kFlatTo));
}

/// Returns the position of the foot on the ground: it rolls over its heel, then about the toe joint, while
/// the toes rest.
FootPosition stance(float phase) {
    const float pitch = stance_pitch(phase);
    const glm::vec2 pivot = pitch > 0 ? glm::vec2(0, -kHeelBehind) : glm::vec2(kBallHeight, kBallAhead);
    const glm::vec2 ankle = glm::vec2(kAnkleHeight, 0) - pivot; // (height, ahead)
    const glm::vec2 rolled(std::cos(pitch) * ankle.x + std::sin(pitch) * ankle.y,
                           std::cos(pitch) * ankle.y - std::sin(pitch) * ankle.x);
    const glm::vec2 point = pivot + rolled + glm::vec2(0, kStepAhead - kStride * phase);
    return {point.x, point.y, pitch, std::max(-pitch, 0.0f)};
}

/// Returns the position of the foot in the air: it continues its motion at toe off, and comes down slightly
/// slower than the ground passes.
FootPosition swing(float phase) {
    constexpr float kStep = 1e-3f, kRetraction = 0.3f;
    const float length = 1 - kStance, t = (phase - kStance) / length;
    const FootPosition before = stance(kStance - kStep), off = stance(kStance), strike = stance(0),
                       after = stance(kStep);
    const auto between = [&](float FootPosition::*value, float slower) {
        return hermite(off.*value, length * (off.*value - before.*value) / kStep, strike.*value,
                       slower * length * (after.*value - strike.*value) / kStep, t);
    };
    const float lifted = 6.75f * kLift * t * (1 - t) * (1 - t); // maximum at a third of the swing
    return {between(&FootPosition::height, 1) + lifted, between(&FootPosition::ahead, kRetraction),
            between(&FootPosition::pitch, 1), between(&FootPosition::toe_bend, 1)};
}

FootPosition foot_position(float phase) {
    phase -= std::floor(phase);
    return phase <= kStance ? stance(phase) : swing(phase);
}

/// Arms hang closer to the body than at rest, swing forward by `forward` and bend by `bent`, radians.
void place_arm(Pose& pose, Side side, float forward, float bent) {
    constexpr float kCloser = 0.20f;
    const auto arm = static_cast<std::size_t>(upper_arm(side));
    pose.rotations[arm] = rotation(-forward, kX) * rotation(-sign_of(side) * kCloser, kZ);
    pose.rotations[arm + 1] = rotation(-bent, kX);
    pose.rotations[arm + 2] = rotation(sign_of(side) * -0.08f, kZ);
}

/// `phase` is that of the left leg.
Pose walking(float phase) {
    const float leg = wave(phase), aside = wave(phase - 0.3f);
    const float yaw = glm::radians(-6.0f) * leg, roll = glm::radians(2.5f) * aside;
    Pose pose;
    pose.hips_position = {kSway * aside, kHipsHeight + kBob * wave(2 * (phase - 0.3f)), 0};
    pose.rotations[hips] = rotation(yaw, kY) * rotation(roll, kZ);
    // The chest rotates against the hips, and the head looks ahead.
    pose.rotations[spine] =
        rotation(-roll, kZ) * rotation(-0.85f * yaw, kY) * rotation(glm::radians(3.0f), kX);
    pose.rotations[chest] = rotation(-0.85f * yaw, kY);
    pose.rotations[neck] = rotation(0.35f * yaw, kY) * rotation(glm::radians(-1.5f), kX);
    pose.rotations[head] = rotation(0.35f * yaw, kY) * rotation(glm::radians(-1.5f), kX);
    for (const Side side : kSides) {
        const float arm = wave(phase + (side == Side::left ? 0.5f : 0.0f));
        place_arm(pose, side, glm::radians(3.0f + 23 * arm), glm::radians(24.0f + 12 * arm));
        place_foot(pose, side, foot_position(phase + (side == Side::left ? 0.0f : 0.5f)), kFootAside);
    }
    return pose;
}

Pose standing(float phase) {
    const float breath = wave(phase);
    Pose pose;
    pose.hips_position = joints()[hips].position;
    pose.rotations[spine] = rotation(glm::radians(0.6f) * breath, kX);
    pose.rotations[chest] = rotation(glm::radians(-1.2f) * breath, kX);
    pose.rotations[head] =
        rotation(glm::radians(6.0f) * wave(phase - 0.25f), kY) * rotation(glm::radians(0.6f) * breath, kX);
    for (const Side side : kSides)
        place_arm(pose, side, glm::radians(2.0f + breath), glm::radians(12.0f - breath));
    return pose;
}

} // namespace

Movement walk() {
    Movement movement = movement_of("walk", walking, kPeriod, kWalkKeys);
    movement.speed = kSpeed;
    return movement;
}

Movement idle() {
    return movement_of("idle", standing, kIdlePeriod, kIdleKeys);
}

} // namespace examples::anatomy
