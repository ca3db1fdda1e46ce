#pragma once

// How bright the lamps of a model are set.

#include "prt/transfer_layout.h"

#include <CLI/CLI.hpp>
#include <glm/vec3.hpp>

#include <filesystem>
#include <vector>

namespace prt::cli {

/// As the scene has them, dark, or as a file says.
struct LampChoice {
    bool on = true;
    std::filesystem::path file = {}; ///< {"NAME": strength or [red, green, blue], "*": of all others}
};

/// --lamps
void add_lamps(CLI::App* command, LampChoice& lamps);

/// [layout.lamps()]. Throws `Error` for a file that names no lamp of the layout, and for strengths that are
/// negative or not finite.
std::vector<glm::vec3> lamp_strengths(const LampChoice& lamps, const TransferLayout& layout);

} // namespace prt::cli
