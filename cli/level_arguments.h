#pragma once

// Arguments of prt bake for coarser levels of detail.

#include "prt/level_bake.h"
#include "session.h"

#include <CLI/CLI.hpp>

#include <optional>

namespace prt::cli {

enum class LevelMode {
    carry,  ///< they copy the transfer of level 0
    own,    ///< each level is baked in place of level 0
    ignore, ///< levels are ignored
};

void add_levels(CLI::App* command, LevelMode& mode);
const char* to_string(LevelMode mode);

/// Levels of a file, and the result of their bake.
struct BakedLevels {
    LeveledScene scene;
    LevelMode mode = LevelMode::carry;
    LevelBake bake;
};

/// Returns the levels of `document` if the mode uses them; prints notices about invalid ones. Throws `Error`
/// if transfer cannot be copied to one.
std::optional<BakedLevels> find_levels(LevelMode mode, const Path& path, const GltfDocument& document,
                                       int threads);

/// Bakes or copies the transfer of `levels`, given that of level 0.
void bake_levels(BakedLevels& levels, const Transfer& finest, const BakeOptions& options,
                 const Progress& progress);

} // namespace prt::cli
