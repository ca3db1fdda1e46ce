#pragma once

// Options of commands that bake into textures.

#include "cli/pipeline/texel_room.h"
#include "cli/program/session.h"

#include <CLI/CLI.hpp>

#include <string>

namespace prt::cli {

/// Adds --texels and --high-poly. Returns --texels. `text` says what is baked.
CLI::Option* add_texels(CLI::App* command, TexelRequest& request, const std::string& text);

/// Throws `Error` for settings of --texels and --high-poly without their values. `texels`: result of
/// `add_texels`.
void check_texels(const TexelRequest& request, const CLI::Option* texels);

} // namespace prt::cli
