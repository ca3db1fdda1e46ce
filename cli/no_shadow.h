#pragma once

// Shells round a scene that let light in.

#include "prt/scene.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace prt::cli {

/// --no-shadow
void add_no_shadow(CLI::App* command, std::vector<std::string>& materials);

/// Surfaces of these materials stop no light. Throws `Error` for a name that no material has.
void leave_out_shadows(Scene& scene, const std::vector<std::string>& materials);

} // namespace prt::cli
