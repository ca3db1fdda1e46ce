// Finds and bakes coarser levels of detail.

#include "level_arguments.h"

#include "options.h"
#include "outputs.h"

#include <map>
#include <string>

namespace prt::cli {
namespace {

const std::map<std::string, LevelMode> kLevelModes = {
    {"carry", LevelMode::carry}, {"own", LevelMode::own}, {"ignore", LevelMode::ignore}};

} // namespace

void add_levels(CLI::App* command, LevelMode& mode) {
    choice(
        command, "--levels", mode, kLevelModes,
        "coarser levels of detail of nodes, by MSFT_lod or by names as ROCK_LOD0, ROCK_LOD1, which cast no "
        "shadow: carry: they get the light of level 0, as their surface shows it best; own: each is baked "
        "in the place of level 0, which takes as long again; ignore: they get none",
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
