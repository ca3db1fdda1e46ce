#pragma once

#include "prt/render/camera.h"

#include <glm/vec2.hpp>

namespace viewer {

/// A camera on a sphere about its target.
class OrbitCamera {
public:
    OrbitCamera() = default;
    explicit OrbitCamera(const prt::Camera& camera);

    /// Rotates the camera. `rotations` is the pointer movement as a fraction of the window height; one height
    /// rotates by 180 degrees.
    void orbit(const glm::vec2& rotations);
    /// Moves the target with the pointer; `way` is the pointer movement as a fraction of the window height.
    void pan(const glm::vec2& way);
    /// Moves closer for positive `notches`.
    void zoom(float notches);

    prt::Camera camera() const;

private:
    glm::vec3 target_{0};
    float distance_ = 1, yaw_ = 0, pitch_ = 0, field_of_view_ = 0.61f;
};

} // namespace viewer
