#pragma once

// Camera and exposure of pictures.

#include "prt/load/scene.h"
#include "prt/render/camera.h"

#include <glm/vec3.hpp>

#include <optional>

namespace prt::pipeline {

/// Exposure of a picture.
struct Exposure {
    bool automatic = true; ///< from the visible surfaces of the model
    double stops = 0;      ///< stops of exposure, added to the automatic ones
};

/// Camera and size of a picture.
struct View {
    int width = 1280, height = 720, samples = 2;
    std::optional<glm::dvec3> camera, look_at; ///< metres, world
    double field_of_view_degrees = 35;
};

/// Returns the camera of `view`; by default one that sees the whole scene.
Camera choose_camera(const View& view, const Scene& scene);

} // namespace prt::pipeline
