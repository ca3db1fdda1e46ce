#pragma once

// What prt bake does about coarser levels of detail.

#include "prt/level_bake.h"
#include "session.h"

#include <CLI/CLI.hpp>

#include <optional>

namespace prt::cli {

enum class LevelMode {
    carry,  ///< they take the transfer of level 0
    own,    ///< each is baked in the place of level 0
    ignore, ///< they have none
};

void add_levels(CLI::App* command, LevelMode& mode);
const char* to_string(LevelMode mode);

/// Levels of a file, and what came of them.
struct BakedLevels {
    LeveledScene scene;
    LevelMode mode = LevelMode::carry;
    LevelBake bake;
};

/// The levels that `document` has, where the mode asks for them; prints what is wrong with some. Throws
/// `Error` where one cannot be carried over.
std::optional<BakedLevels> find_levels(LevelMode mode, const Path& path, const GltfDocument& document,
                                       int threads);

/// Gives `levels` their transfer beside that of level 0.
void bake_levels(BakedLevels& levels, const Transfer& finest, const BakeOptions& options,
                 const Progress& progress);

} // namespace prt::cli
