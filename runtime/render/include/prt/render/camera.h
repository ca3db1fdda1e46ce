#pragma once

// Cameras and the view rays of pixels. Experimental.

#include "prt/core/glm_layout.h"
#include "prt/load/scene.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace prt {

/// Maximum absolute value of each coordinate of Camera::position and Camera::target, metres. Embree supports
/// ray origins up to 1.8e18. An automatic camera is much closer, unless its field of view is extremely small.
inline constexpr float kFarthestCamera = 1e18f;

/// A pinhole camera. Positions are in metres, relative to Scene::origin.
struct Camera {
    glm::vec3 position{0, 0, 1};
    glm::vec3 target{0};                  ///< point in the center of the picture; differs from `position`
    glm::vec3 up{0, 1, 0};                ///< direction, not 0 and not parallel to the view direction
    float vertical_field_of_view = 0.61f; ///< full angle from the bottom to the top of the picture, radians

    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Returns a camera with `up` +Y that sees all triangles of `scene`. The camera is on the +Z side of the
/// scene, the front of glTF models, and slightly to the right and above. `aspect`: width over height of the
/// picture. `vertical_field_of_view`: full angle, radians. `scene` must have at least one triangle.
Camera automatic_camera(const Scene& scene, float aspect, float vertical_field_of_view);

/// View directions of a camera.
struct CameraFrame {
    glm::dvec3 forward, right, up; ///< orthogonal unit vectors in the axes of the scene
    double half_height;            ///< half the height of the image plane at distance 1 from the camera
};
/// Returns the frame of `camera`. Throws `Error` if the camera looks along `up` or -`up`, if `up` is 0, if
/// `position` equals `target`, or if a coordinate of `position` or `target` is not finite or exceeds
/// `kFarthestCamera`.
CameraFrame camera_frame(const Camera& camera);

/// Returns the direction from the camera through point (x, y) of a picture of `width` x `height` pixels, in
/// the axes of the scene. The direction is not normalised: its component along `frame.forward` is 1. `x`
/// (right) and `y` (down) are in pixels: (0, 0) is the top left corner, and the center of the first pixel is
/// at (0.5, 0.5).
glm::dvec3 view_direction(const CameraFrame& frame, int width, int height, double x, double y);

/// Returns the matrix from positions relative to Scene::origin to OpenGL clip space (z from -w to w). Near
/// and far planes enclose `box` with a margin of 1 %, but the distance of the near plane is at least 1e-4 of
/// the distance of the farthest corner of `box`. If the whole box is behind the camera, this distance counts
/// as 1 m. `aspect`: width over height of the picture. Throws the errors of `camera_frame`.
glm::mat4 view_projection(const Camera& camera, const Bounds& box, float aspect);

} // namespace prt
