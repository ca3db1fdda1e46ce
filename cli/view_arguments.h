#pragma once

// How pictures are framed and exposed: options that `render` shares with whatever draws.

#include "prt/camera.h"
#include "prt/scene.h"

#include <CLI/CLI.hpp>
#include <glm/vec3.hpp>

#include <optional>

namespace prt::cli {

/// How bright a picture is.
struct Exposure {
    bool automatic = true; ///< by what the model shows
    double stops = 0;      ///< of radiance, or beside the automatic ones
};

/// From where, and with how many pixels.
struct View {
    int width = 1280, height = 720, samples = 2;
    std::optional<glm::dvec3> camera, look_at; ///< metres, world
    double field_of_view_degrees = 35;
};

/// --size, --camera, --look-at, --fov
void add_view(CLI::App* command, View& view);

/// --exposure
CLI::Option* add_exposure(CLI::App* command, Exposure& exposure);

/// The camera of `view`; where it is not given, one that sees the whole scene.
Camera choose_camera(const View& view, const Scene& scene);

} // namespace prt::cli
