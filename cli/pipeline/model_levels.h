#pragma once

// Bakes coarser levels of detail.

#include "cli/pipeline/host.h"
#include "prt/bake/level_bake.h"

#include <optional>

namespace prt::pipeline {

/// Levels of a file, and the result of their bake.
struct BakedLevels {
    LeveledScene scene;
    LevelMode mode = LevelMode::carry;
    LevelBake bake;
};

/// Returns the levels of `document`, without those whose vertices all have lobes: they need no transfer.
LeveledScene levels_without_lobes(const GltfDocument& document);

/// Returns `levels_without_lobes` if the mode uses them; sends notices about invalid ones. Throws `Error` if
/// transfer cannot be copied to one.
std::optional<BakedLevels> find_levels(LevelMode mode, const Path& path, const GltfDocument& document,
                                       int threads, const Notify& notify);

/// Bakes or copies the transfer of `levels`, given that of level 0. `finer`: as for `bake`.
void bake_levels(BakedLevels& levels, const Transfer& finest, const BakeOptions& options,
                 const Progress& progress, const FinerModel& finer = {});

} // namespace prt::pipeline
