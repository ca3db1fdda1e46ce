// Finds and bakes coarser levels of detail.

#include "cli/pipeline/model_levels.h"

#include <string>

namespace prt::pipeline {
const char* to_string(LevelMode mode) {
    switch (mode) {
    case LevelMode::carry:
        return "carry";
    case LevelMode::own:
        return "own";
    case LevelMode::ignore:
        break;
    }
    return "ignore";
}

std::optional<BakedLevels> find_levels(LevelMode mode, const Path& path, const GltfDocument& document,
                                       int threads, const Notify& notify) {
    if (!has_levels(document))
        return std::nullopt;
    BakedLevels levels{extract_levels(document), mode, {}};
    send(notify, path, levels.scene.notices);
    if (levels.scene.nodes.empty())
        return std::nullopt;
    if (mode == LevelMode::carry)
        check_levels(levels.scene, {.threads = threads});
    return levels;
}

void bake_levels(BakedLevels& levels, const Transfer& finest, const BakeOptions& options,
                 const Progress& progress, const FinerModel& finer) {
    levels.bake = levels.mode == LevelMode::own
                      ? prt::bake_levels(levels.scene, finest, options, progress, finer)
                      : carry_levels(levels.scene, finest, {.seed = options.seed, .threads = options.threads},
                                     progress);
}

} // namespace prt::pipeline
