#pragma once

// Options of commands that bake into textures.

#include "cli/pipeline/texel_room.h"
#include "cli/program/session.h"

#include <CLI/CLI.hpp>

#include <string>

namespace prt::cli {

/// Adds --high-poly. `details`: more lines of its help, each after a newline.
void add_high_poly(CLI::App* command, HighPolyRequest& request, const std::string& details);

/// Throws `Error` for a distance without a file.
void check_high_poly(const HighPolyRequest& request);

/// Adds --texels and --high-poly. Returns --texels. `text` says what is baked.
CLI::Option* add_texels(CLI::App* command, TexelRequest& request, const std::string& text);

/// Throws `Error` for settings of --texels and --high-poly without their values. `texels`: result of
/// `add_texels`.
void check_texels(const TexelRequest& request, const CLI::Option* texels);

} // namespace prt::cli
