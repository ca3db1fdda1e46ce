// Chooses cameras.

#include "cli/pipeline/view.h"

#include <glm/trigonometric.hpp>

namespace prt::pipeline {

Camera choose_camera(const View& view, const Scene& scene) {
    const float aspect = static_cast<float>(view.width) / static_cast<float>(view.height);
    const auto fov = static_cast<float>(glm::radians(view.field_of_view_degrees));
    Camera camera = automatic_camera(scene, aspect, fov);
    if (view.look_at)
        camera.target = glm::vec3(*view.look_at - scene.origin);
    if (view.camera)
        camera.position = glm::vec3(*view.camera - scene.origin);
    return camera;
}

} // namespace prt::pipeline
