#pragma once

#include "prt/scene.h"
#include "prt/support/glm_layout.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace prt {

/// A pinhole camera. `up` must not point along the view.
struct Camera {
    glm::vec3 position{0, 0, 1};
    glm::vec3 target{0};
    glm::vec3 up{0, 1, 0};
    float vertical_field_of_view = 0.61f; ///< radians

    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Sees all of `scene` from the front, a little from the right and above (glTF models face +Z).
Camera automatic_camera(const Scene& scene, float aspect, float vertical_field_of_view);

/// Orthonormal frame of the camera and half the height of the image plane at distance 1. Pixel (x, y) of an
/// image of w x h, from the top, is seen along forward + right · half_height · aspect · (2 (x + 0.5) / w - 1)
/// + up · half_height · (1 - 2 (y + 0.5) / h).
struct CameraFrame {
    glm::dvec3 forward, right, up;
    double half_height;
};
CameraFrame camera_frame(const Camera& camera);

/// World to OpenGL clip space, with near and far planes just round `box`.
glm::mat4 view_projection(const Camera& camera, const Bounds& box, float aspect);

} // namespace prt
