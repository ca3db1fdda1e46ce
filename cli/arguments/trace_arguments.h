#pragma once

// Options for the measurement of light at receivers: method and number of rays.

#include "prt/bake/bake_options.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace prt::cli {

/// Adds --method. `by_rays`: light that rays trace also with depth maps, for the help.
void add_method(CLI::App* command, TracerChoice& tracer, const std::string& by_rays);
/// Throws if --method has a resolution that has no effect.
void check_method(const TracerChoice& tracer);

/// Adds --target-error, which excludes `rays`. `details`: more lines of its help, each after a newline.
void add_target_error(CLI::App* command, CLI::Option* rays, std::optional<double>& target,
                      const std::string& details);

} // namespace prt::cli
