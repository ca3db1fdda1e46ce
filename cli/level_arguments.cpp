// Finds and bakes coarser levels of detail.

#include "level_arguments.h"

#include "options.h"
#include "outputs.h"

#include <string>

namespace prt::cli {
namespace {

constexpr Choice<LevelMode> kLevelModes[] = {
    {"carry", LevelMode::carry, "fit the light of level 0 to the surface of the coarser level"},
    {"own", LevelMode::own, "bake each coarser level instead of level 0; each takes as long as level 0"},
    {"ignore", LevelMode::ignore, "coarser levels get no transfer"}};

} // namespace

void add_levels(CLI::App* command, LevelMode& mode) {
    choice(command, "--levels", mode, kLevelModes,
           "transfer of coarser levels of detail\n"
           "levels: nodes of MSFT_lod, or nodes with names as ROCK_LOD1",
           "carry");
}

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
                                       int threads) {
    if (!has_levels(document))
        return std::nullopt;
    BakedLevels levels{extract_levels(document), mode, {}};
    print_notices(path.string(), levels.scene.notices);
    if (levels.scene.nodes.empty())
        return std::nullopt;
    if (mode == LevelMode::carry)
        check_levels(levels.scene, {.threads = threads});
    return levels;
}

void bake_levels(BakedLevels& levels, const Transfer& finest, const BakeOptions& options,
                 const Progress& progress) {
    levels.bake = levels.mode == LevelMode::own
                      ? prt::bake_levels(levels.scene, finest, options, progress)
                      : carry_levels(levels.scene, finest, {.seed = options.seed, .threads = options.threads},
                                     progress);
}

} // namespace prt::cli
