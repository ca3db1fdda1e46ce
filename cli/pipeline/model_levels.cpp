// Finds and bakes coarser levels of detail.

#include "cli/pipeline/model_levels.h"

namespace prt::pipeline {
LeveledScene levels_without_lobes(const GltfDocument& document) {
    LeveledScene levels = extract_levels(document);
    keep_levels(levels.nodes, levels.scene,
                [&](const Primitive& p) { return !levels.scene.vertex_arrays[p.vertices].lobes; });
    return levels;
}

std::optional<BakedLevels> find_levels(LevelMode mode, const Path& path, const GltfDocument& document,
                                       int threads, const Notify& notify) {
    if (!has_levels(document))
        return std::nullopt;
    BakedLevels levels{levels_without_lobes(document), mode, {}};
    send(notify, path, levels.scene.notices);
    if (levels.scene.nodes.empty())
        return std::nullopt;
    if (mode == LevelMode::carry)
        check_levels(levels.scene, {.threads = threads});
    return levels;
}

void bake_levels(BakedLevels& levels, const Transfer& finest, const BakeOptions& options,
                 const Progress& progress, const FinerModel& finer) {
    levels.bake = transfer_of_levels(levels.scene, finest, levels.mode, options, {}, progress, finer);
}

} // namespace prt::pipeline
