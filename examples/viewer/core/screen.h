#pragma once

// Converts between positions in the scene and pixels of the screen, counted from its top left.

#include "prt/render/camera.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>

namespace viewer {

struct Screen {
    prt::Camera camera;
    glm::vec2 size{1};
};

/// Returns the unit direction from the camera through `pixel`.
glm::vec3 direction_through(const Screen& screen, const glm::vec2& pixel);
/// Returns the pixel of the position `position`; empty if it is behind the camera.
std::optional<glm::vec2> pixel_of(const Screen& screen, const glm::vec3& position);

/// Returns the unit direction from `center` to the intersection of the ray through `pixel` with the sphere of
/// that radius: its near side, or its far side if `far_side`. A ray that misses returns the nearest point of
/// the outline.
glm::vec3 direction_on_sphere(const Screen& screen, const glm::vec2& pixel, const glm::vec3& center,
                              float radius, bool far_side);

} // namespace viewer
