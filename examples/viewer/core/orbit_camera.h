#pragma once

#include "prt/camera.h"

#include <glm/vec2.hpp>

namespace viewer {

/// A camera on a sphere about a point that it looks at.
class OrbitCamera {
public:
    OrbitCamera() = default;
    explicit OrbitCamera(const prt::Camera& camera);

    /// `turns` is the way of the pointer as a share of the window's height: one height is half a turn.
    void orbit(const glm::vec2& turns);
    /// Moves what is looked at with the pointer; `way` as above.
    void pan(const glm::vec2& way);
    /// Nearer for positive `notches`.
    void zoom(float notches);

    prt::Camera camera() const;

private:
    glm::vec3 target_{0};
    float distance_ = 1, yaw_ = 0, pitch_ = 0, field_of_view_ = 0.61f;
};

} // namespace viewer
