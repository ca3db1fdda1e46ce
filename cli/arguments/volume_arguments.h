#pragma once

// Options of `bake` that request a volume in addition to transfer of surfaces.

#include "cli/pipeline/model.h"
#include "cli/program/session.h"
#include "prt/bake/volume_bake.h"

#include <CLI/CLI.hpp>

namespace prt::cli {

struct VolumeArguments {
    VolumeOptions volume{.spacing = 0};
    struct WorldBounds {
        glm::dvec3 least{0}, most{0};
    };
    std::optional<WorldBounds> bounds;
    const CLI::Option* option = nullptr; ///< --volume

    /// True if a volume is requested.
    bool given() const { return volume.spacing > 0 || volume.probes > 0; }
};

void add_volume(CLI::App* command, VolumeArguments& arguments);

/// Throws `Error` for options of volumes if no volume is requested.
void check_volume(const VolumeArguments& arguments);

/// Returns the options for a scene; bounds are converted to its coordinates.
VolumeOptions volume_options(const VolumeArguments& arguments, const Scene& scene);

} // namespace prt::cli
