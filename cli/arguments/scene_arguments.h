#pragma once

// Options for the geometry of a scene: materials without shadow, back sides, levels of detail, instances.

#include "cli/pipeline/back_sides.h"
#include "cli/pipeline/instance_sharing.h"
#include "cli/pipeline/model_levels.h"
#include "cli/program/session.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace prt::cli {

/// Adds --no-shadow. `details`: more lines of its help, each after a newline.
void add_no_shadow(CLI::App* command, std::vector<std::string>& materials, const std::string& details = "");

/// Adds --back-sides. `details`: more lines of its help, each after a newline.
void add_back_sides(CLI::App* command, BackSides& sides, const std::string& details = "");

/// Adds --levels. `details`: more lines of its help, each after a newline.
void add_levels(CLI::App* command, LevelMode& mode, const std::string& details);

/// Adds --instances and its related options.
void add_instances(CLI::App* command, InstanceArguments& arguments);

} // namespace prt::cli
