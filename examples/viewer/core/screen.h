#pragma once

// Between places in the scene and pixels of the screen, from its top left.

#include "prt/camera.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>

namespace viewer {

struct Screen {
    prt::Camera camera;
    glm::vec2 size{1};
};

/// Unit direction from the camera through `pixel`.
glm::vec3 direction_through(const Screen& screen, const glm::vec2& pixel);
/// Nothing where `place` is behind the camera.
std::optional<glm::vec2> pixel_of(const Screen& screen, const glm::vec3& place);

/// Unit direction from `center` to where the ray through `pixel` meets the sphere of that radius: its near
/// side, or its far side where `far_side`; beside it the nearest point of its outline.
glm::vec3 direction_on_sphere(const Screen& screen, const glm::vec2& pixel, const glm::vec3& center,
                              float radius, bool far_side);

} // namespace viewer
