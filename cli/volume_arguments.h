#pragma once

// Options of `bake` that ask for a volume beside what surfaces get.

#include "inputs.h"
#include "prt/volume_bake.h"

#include <CLI/CLI.hpp>

namespace prt::cli {

struct VolumeArguments {
    VolumeOptions volume{.spacing = 0};
    struct WorldBounds {
        glm::dvec3 least{0}, most{0};
    };
    std::optional<WorldBounds> bounds;

    /// Whether one is asked for.
    bool given() const { return volume.spacing > 0 || volume.probes > 0; }
};

void add_volume(CLI::App* command, VolumeArguments& arguments);

/// Throws `Error` for options of volumes where none is asked for.
void check_volume(const VolumeArguments& arguments);

/// Of a scene, in whose frame bounds then are.
VolumeOptions volume_options(const VolumeArguments& arguments, const Scene& scene);

} // namespace prt::cli
