#pragma once

// Options of `bake` that request a volume in addition to transfer of surfaces.

#include "cli/pipeline/bake_model.h"
#include "cli/program/session.h"

#include <CLI/CLI.hpp>

namespace prt::cli {

/// Adds --volume and returns it.
CLI::Option* add_volume(CLI::App* command, VolumeRequest& request);

/// Throws `Error` for options of volumes if no volume is requested. `option`: result of `add_volume`.
void check_volume(const VolumeRequest& request, const CLI::Option* option);

} // namespace prt::cli
