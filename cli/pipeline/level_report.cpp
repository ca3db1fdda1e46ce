// Reports the bake and the errors of coarser levels.

#include "cli/pipeline/level_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace prt::pipeline {
namespace {

/// One level of all nodes.
struct LevelSum {
    std::size_t nodes = 0, triangles = 0, vertices = 0;
    LevelSquares squares;
    double farthest = 0, worst = 0;
};

std::map<int, LevelSum> sums_of(const LevelBake& bake) {
    std::map<int, LevelSum> sums;
    for (const LevelOutcome& outcome : bake.levels) {
        LevelSum& sum = sums[outcome.level];
        ++sum.nodes;
        sum.triangles += outcome.triangles;
        sum.vertices += outcome.vertices;
        sum.squares += outcome.squares;
        sum.farthest = std::max(sum.farthest, outcome.largest_distance);
        sum.worst = std::max(sum.worst, outcome.squares.relative_l2());
    }
    return sums;
}

Json all_json(const LevelBake& bake) {
    Json list = Json::array();
    for (const LevelOutcome& o : bake.levels)
        list.push_back({{"level", o.level},
                        {"name", o.name},
                        {"level_0", o.of},
                        {"triangles", o.triangles},
                        {"vertices", o.vertices},
                        {"samples", o.samples},
                        {"rms_distance_metres", o.rms_distance},
                        {"max_distance_metres", o.largest_distance},
                        {"diagonal_metres", o.diagonal},
                        {"relative_l2", o.squares.relative_l2()}});
    return list;
}

std::string how_found(const LeveledScene& scene) {
    const auto named = std::ranges::count_if(scene.nodes, &LeveledNode::by_name);
    if (named == 0)
        return "MSFT_lod";
    return static_cast<std::size_t>(named) == scene.nodes.size() ? "node names" : "MSFT_lod and node names";
}

} // namespace

void add_level_bake(const BakedLevels& levels, Report& report) {
    Json by_level = Json::array();
    for (const auto& [level, sum] : sums_of(levels.bake))
        by_level.push_back({{"level", level},
                            {"nodes", sum.nodes},
                            {"triangles", sum.triangles},
                            {"vertices", sum.vertices},
                            {"max_distance_metres", sum.farthest},
                            {"relative_l2", sum.squares.relative_l2()},
                            {"max_relative_l2", sum.worst}});
    const std::size_t count = by_level.size();
    add_figures(report, {{"levels",
                          {{"mode", to_string(levels.mode)},
                           {"nodes", levels.scene.nodes.size()},
                           {"by_level", std::move(by_level)},
                           {"all", all_json(levels.bake)},
                           {"seconds", levels.bake.seconds},
                           {"notices", levels.bake.notices}}}});
    report.sentences.push_back(
        fmt::format("levels of detail (from {}) of {{levels/nodes:#node}}: {}", how_found(levels.scene),
                    levels.mode == LevelMode::ignore ? "coarser levels have no transfer"
                    : levels.mode == LevelMode::own
                        ? "each level is baked in place of level 0, in {levels/seconds:.3f} s"
                        : "level 0 is baked; coarser levels are fitted to it in {levels/seconds:.3f} s"));
    for (std::size_t i = 0; i < count; ++i)
        report.sentences.push_back(fmt::format(
            "level {{levels/by_level/{0}/level}}: {{levels/by_level/{0}/triangles:#triangle}}, "
            "{{levels/by_level/{0}/vertices:#vertex|vertices}}; difference from level 0 over its surface: "
            "{{levels/by_level/{0}/relative_l2:.3f%}} (relative L2 of the transfer)",
            i));
    for (std::size_t i = 0; i < levels.bake.notices.size(); ++i)
        report.sentences.push_back(fmt::format("{{levels/notices/{}}}", i));
}

} // namespace prt::pipeline
