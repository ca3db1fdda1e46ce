#pragma once

// Cameras and the rays of their pixels. Experimental.

#include "prt/scene.h"
#include "prt/support/glm_layout.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace prt {

/// The farthest that a camera, and what it looks at, may lie from the scene's origin along each axis, metres:
/// Embree takes rays that start up to 1.8e18 away. An automatic camera never comes near it.
inline constexpr float kFarthestCamera = 1e18f;

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

/// Orthonormal frame of the camera and half the height of the image plane at distance 1.
struct CameraFrame {
    glm::dvec3 forward, right, up;
    double half_height;
};
/// Throws `Error` for a camera that looks along `up` or at itself, or lies beyond `kFarthestCamera`.
CameraFrame camera_frame(const Camera& camera);

/// The direction, not unit, in which the position (x, y) of an image of `width` x `height` is seen; (0, 0) is
/// its top left corner, the center of pixel i at i + 0.5.
glm::dvec3 view_direction(const CameraFrame& frame, int width, int height, double x, double y);

/// World to OpenGL clip space, with near and far planes just round `box`.
glm::mat4 view_projection(const Camera& camera, const Bounds& box, float aspect);

} // namespace prt
