#pragma once

// Positions of the courtyard's walls, in metres. The court extends from x = -kHalf to kHalf and from z =
// -kDeep to 0, and is open to the front (+z). A two-storey arcade is on its left and at its back, a garden
// wall on its right.

#include "example_scenes.h"

namespace examples::plan {

inline constexpr int kBays = 5;
inline constexpr float kBay = 2.2f, kDeep = kBay * kBays, kHalf = kDeep / 2;
inline constexpr float kGallery = 2.6f;     ///< depth behind the arcade
inline constexpr float kArcadeWall = 0.36f; ///< thickness
inline constexpr float kOuterWall = 0.3f;
inline constexpr float kWing = kArcadeWall + kGallery + kOuterWall; ///< depth of a wing
inline constexpr float kStep = 0.14f;  ///< the galleries lie higher than the court
inline constexpr float kSpring = 2.5f; ///< height of the arches' feet
inline constexpr float kArch = 0.86f;  ///< radius of their openings
inline constexpr float kStorey = 4.3f, kEaves = 7.3f;
inline constexpr float kRoofSlope = 0.36f;
inline constexpr float kGardenWall = 2.9f; ///< height
inline constexpr float kFront = 6;         ///< extent of the paving in front of the court
inline constexpr float kTall = 0.5f;       ///< spacing of vertices where nobody looks

/// From the frame of a wing, in which its front is the plane z = 0, facing +z, from x = 0 to kDeep.
inline glm::mat4 left_wing() {
    return placement({-kHalf, 0, 0}, 90);
}
inline glm::mat4 back_wing() {
    return placement({-kHalf, 0, -kDeep}, 0);
}

} // namespace examples::plan
