#pragma once

// Options for the camera and exposure of pictures.

#include "cli/pipeline/view.h"

#include <CLI/CLI.hpp>

namespace prt::cli {

using namespace pipeline;

/// --size, --camera, --look-at, --fov
void add_view(CLI::App* command, View& view);

/// --exposure
CLI::Option* add_exposure(CLI::App* command, Exposure& exposure);

} // namespace prt::cli
