#pragma once

// Cameras and the view rays of pixels. Experimental.

#include "prt/scene.h"
#include "prt/support/glm_layout.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace prt {

/// Maximum distance of a camera and its target from the scene's origin along each axis, metres: Embree
/// supports ray origins up to 1.8e18. An automatic camera is always much closer.
inline constexpr float kFarthestCamera = 1e18f;

/// A pinhole camera. `up` must not be parallel to the view direction.
struct Camera {
    glm::vec3 position{0, 0, 1};
    glm::vec3 target{0};
    glm::vec3 up{0, 1, 0};
    float vertical_field_of_view = 0.61f; ///< radians

    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Returns a camera that sees all of `scene` from the front, slightly from the right and above (glTF models
/// face +Z).
Camera automatic_camera(const Scene& scene, float aspect, float vertical_field_of_view);

/// Orthonormal frame of the camera, and half the height of the image plane at distance 1.
struct CameraFrame {
    glm::dvec3 forward, right, up;
    double half_height;
};
/// Returns the frame of `camera`. Throws `Error` if it looks along `up`, if `position` equals `target`, or if
/// one of them is beyond `kFarthestCamera`.
CameraFrame camera_frame(const Camera& camera);

/// Returns the view direction, not normalised, at position (x, y) of an image of `width` x `height` pixels.
/// (0, 0) is the top left corner; the center of pixel i is at i + 0.5.
glm::dvec3 view_direction(const CameraFrame& frame, int width, int height, double x, double y);

/// Returns the matrix from the frame of the scene to OpenGL clip space. Near and far planes enclose `box`
/// tightly.
glm::mat4 view_projection(const Camera& camera, const Bounds& box, float aspect);

} // namespace prt
