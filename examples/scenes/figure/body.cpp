// Sections of a body of 1.8 m, metres: along the axis of each part, half its width, half its depth, how far
// ahead.
#include "figure/body.h"

#include "figure/bones.h"

#include <glm/geometric.hpp>

#include <array>

namespace examples::anatomy {
namespace {

constexpr glm::vec3 kUp(0, 1, 0), kAhead(0, 0, 1);

glm::vec3 rest_position(int bone) {
    return joints()[static_cast<std::size_t>(bone)].position;
}

SoftMesh torso() {
    constexpr std::array sections = {
        Section{0.87f, 0.170f, 0.118f},           Section{0.95f, 0.166f, 0.118f},
        Section{1.03f, 0.153f, 0.108f},           Section{1.12f, 0.150f, 0.104f},
        Section{1.22f, 0.164f, 0.114f, 0.003f},   Section{1.31f, 0.178f, 0.122f, 0.006f},
        Section{1.385f, 0.182f, 0.116f},          Section{1.44f, 0.172f, 0.096f, -0.008f},
        Section{1.483f, 0.112f, 0.074f, -0.012f}, Section{1.52f, 0.064f, 0.062f, -0.010f}};
    constexpr std::array held = {HeldBy{hips}, HeldBy{spine, 1.04f, 0.07f}, HeldBy{chest, 1.22f, 0.08f}};
    return soft_limb({glm::vec3(0), kUp, kAhead}, sections, held, {.segments = 28, .squareness = 2.4f});
}

SoftMesh sleeve(Side side) {
    constexpr std::array sections = {
        Section{-0.03f, 0.030f, 0.032f}, Section{0.005f, 0.048f, 0.052f}, Section{0.05f, 0.057f, 0.061f},
        Section{0.11f, 0.053f, 0.057f},  Section{0.20f, 0.047f, 0.050f},  Section{0.29f, 0.042f, 0.044f},
        Section{0.36f, 0.042f, 0.043f},  Section{0.45f, 0.036f, 0.037f},  Section{0.545f, 0.031f, 0.033f}};
    const int arm = upper_arm(side);
    const std::array held = {HeldBy{chest}, HeldBy{arm, 0.01f, 0.05f}, HeldBy{arm + 1, kUpperArm, 0.055f}};
    return soft_limb({rest_position(arm), arm_direction(side), kAhead}, sections, held, {.segments = 16});
}

SoftMesh hand(Side side) {
    constexpr std::array palm = {
        Section{0.51f, 0.023f, 0.026f},         Section{0.555f, 0.020f, 0.032f, 0.003f},
        Section{0.60f, 0.018f, 0.042f, 0.006f}, Section{0.65f, 0.016f, 0.043f, 0.006f},
        Section{0.70f, 0.013f, 0.037f, 0.004f}, Section{0.728f, 0.010f, 0.027f, 0.002f}};
    constexpr std::array thumb = {Section{0.0f, 0.013f, 0.013f}, Section{0.035f, 0.013f, 0.013f},
                                  Section{0.06f, 0.010f, 0.010f}};
    const int arm = upper_arm(side);
    const std::array held = {HeldBy{arm + 1}, HeldBy{arm + 2, kUpperArm + kForearm, 0.02f}};
    const std::array held_by_hand = {HeldBy{arm + 2}};
    const glm::vec3 along = arm_direction(side), shoulder = rest_position(arm);
    SoftMesh mesh = soft_limb({shoulder, along, kAhead}, palm, held, {.segments = 14, .last_cap = 0.012f});
    const glm::vec3 thumb_axis = glm::normalize(0.85f * along + 0.53f * kAhead);
    append(mesh, soft_limb({shoulder + 0.58f * along + 0.032f * kAhead, thumb_axis,
                            glm::normalize(glm::cross(glm::cross(thumb_axis, kAhead), thumb_axis))},
                           thumb, held_by_hand, {.segments = 8}));
    return mesh;
}

SoftMesh face() {
    constexpr std::array skull = {
        Section{1.572f, 0.042f, 0.050f, 0.030f}, Section{1.60f, 0.058f, 0.076f, 0.020f},
        Section{1.64f, 0.069f, 0.091f, 0.012f},  Section{1.69f, 0.075f, 0.098f, 0.006f},
        Section{1.735f, 0.075f, 0.097f},         Section{1.768f, 0.063f, 0.082f, -0.004f},
        Section{1.786f, 0.044f, 0.058f, -0.006f}};
    constexpr std::array throat = {Section{1.45f, 0.054f, 0.056f, -0.014f},
                                   Section{1.53f, 0.053f, 0.056f, -0.008f},
                                   Section{1.62f, 0.052f, 0.058f, 0}};
    constexpr std::array nose = {Section{-0.020f, 0.008f, 0.010f, -0.004f}, Section{0.008f, 0.013f, 0.018f},
                                 Section{0.018f, 0.014f, 0.018f}};
    constexpr std::array ear = {Section{-0.022f, 0.008f, 0.014f}, Section{0, 0.010f, 0.018f},
                                Section{0.020f, 0.008f, 0.012f}};
    constexpr std::array held = {HeldBy{head}};
    constexpr std::array throat_held = {HeldBy{chest}, HeldBy{neck, 1.49f, 0.03f},
                                        HeldBy{head, 1.58f, 0.03f}};
    SoftMesh mesh = soft_limb({glm::vec3(0), kUp, kAhead}, skull, held,
                              {.segments = 22, .first_cap = 0.017f, .last_cap = 0.014f});
    append(mesh, soft_limb({glm::vec3(0), kUp, kAhead}, throat, throat_held, {.segments = 18}));
    append(mesh, soft_limb({{0, 1.675f, 0.102f}, -kUp, kAhead}, nose, held,
                           {.segments = 8, .first_cap = 0.006f, .last_cap = 0.006f}));
    for (const Side side : kSides)
        append(mesh,
               soft_limb({{sign_of(side) * 0.077f, 1.675f, 0.0f}, -kUp, kAhead}, ear, held, {.segments = 8}));
    return mesh;
}

SoftMesh hair() {
    constexpr std::array sections = {
        Section{1.625f, 0.066f, 0.060f, -0.036f}, Section{1.66f, 0.077f, 0.080f, -0.022f},
        Section{1.70f, 0.080f, 0.090f, -0.014f},  Section{1.74f, 0.079f, 0.098f, -0.004f},
        Section{1.772f, 0.067f, 0.087f, -0.004f}, Section{1.789f, 0.047f, 0.062f, -0.006f}};
    constexpr std::array held = {HeldBy{head}};
    return soft_limb({glm::vec3(0), kUp, kAhead}, sections, held,
                     {.segments = 22, .first_cap = 0.012f, .last_cap = 0.012f});
}

SoftMesh pelvis() {
    constexpr std::array sections = {Section{0.82f, 0.085f, 0.085f}, Section{0.87f, 0.160f, 0.112f},
                                     Section{0.94f, 0.158f, 0.110f}, Section{1.00f, 0.145f, 0.100f}};
    constexpr std::array held = {HeldBy{hips}};
    return soft_limb({glm::vec3(0), kUp, kAhead}, sections, held,
                     {.segments = 22, .first_cap = 0.03f, .squareness = 2.3f});
}

SoftMesh trouser_leg(Side side) {
    constexpr std::array sections = {
        Section{-0.05f, 0.066f, 0.090f, -0.004f}, Section{0.05f, 0.086f, 0.102f, -0.006f},
        Section{0.15f, 0.080f, 0.090f},           Section{0.28f, 0.066f, 0.074f, 0.002f},
        Section{0.42f, 0.056f, 0.061f, 0.005f},   Section{0.53f, 0.054f, 0.062f, -0.010f},
        Section{0.66f, 0.047f, 0.052f, -0.008f},  Section{0.79f, 0.050f, 0.056f, -0.002f}};
    const int leg = thigh(side);
    const std::array held = {HeldBy{hips}, HeldBy{leg, 0.02f, 0.07f}, HeldBy{leg + 1, kThigh, 0.07f}};
    return soft_limb({rest_position(leg), -kUp, kAhead}, sections, held, {.segments = 18});
}

/// Along the foot, from under the ankle on; the depth of a section is its height.
SoftMesh shoe(Side side) {
    constexpr std::array sections = {
        Section{-0.052f, 0.030f, 0.046f, 0.046f}, Section{-0.02f, 0.038f, 0.056f, 0.050f},
        Section{0.03f, 0.040f, 0.056f, 0.046f},   Section{0.08f, 0.044f, 0.043f, 0.034f},
        Section{0.12f, 0.047f, 0.036f, 0.027f},   Section{0.16f, 0.044f, 0.030f, 0.022f},
        Section{0.18f, 0.035f, 0.025f, 0.019f}};
    constexpr std::array shaft = {Section{0.04f, 0.036f, 0.042f, -0.004f},
                                  Section{0.10f, 0.036f, 0.042f, -0.004f},
                                  Section{0.15f, 0.034f, 0.038f, -0.004f}};
    const int foot = thigh(side) + 2;
    const std::array held = {HeldBy{foot}, HeldBy{foot + 1, kBallAhead, 0.02f}};
    const std::array shaft_held = {HeldBy{foot}};
    const glm::vec3 sole(rest_position(foot).x, 0, 0);
    SoftMesh mesh = soft_limb({sole, kAhead, kUp}, sections, held,
                              {.segments = 16, .first_cap = 0.013f, .last_cap = 0.02f, .floor = 0});
    append(mesh, soft_limb({sole, kUp, kAhead}, shaft, shaft_held, {.segments = 14}));
    return mesh;
}

} // namespace

SoftMesh shirt() {
    SoftMesh mesh = torso();
    for (const Side side : kSides)
        append(mesh, sleeve(side));
    return mesh;
}

SoftMesh dark_parts() {
    SoftMesh mesh = pelvis();
    for (const Side side : kSides) {
        append(mesh, trouser_leg(side));
        append(mesh, shoe(side));
    }
    append(mesh, hair());
    return mesh;
}

SoftMesh skin_parts() {
    SoftMesh mesh = face();
    for (const Side side : kSides)
        append(mesh, hand(side));
    return mesh;
}

} // namespace examples::anatomy
