// Bakes scenes in which coarser levels replace level 0.

#include "bake/products/levels/level_surface.h"
#include "prt/core/error.h"
#include "runtime/core/support/stopwatch.h"

#include <algorithm>
#include <set>

namespace prt {
namespace {

bool same_layout(const TransferLayout& a, const TransferLayout& b) {
    return a.order == b.order && std::ranges::equal(a.terms, b.terms, [](const auto& p, const auto& q) {
               return p.kind == q.kind && p.channels == q.channels && p.name == q.name;
           });
}

/// Copies the transfer of a level, and its sealed receivers.
void copy_level(const ScenePart& part, const BakeResult& from, std::size_t finest_receivers, LevelBake& to) {
    for (std::size_t p = 0; p < part.receivers.size(); ++p)
        if (part.receivers[p] >= finest_receivers)
            std::ranges::copy(from.baked.transfer.vector(p), to.transfer.vector(part.receivers[p]).begin());
    for (const std::uint32_t p : from.sealed)
        if (part.receivers[p] >= finest_receivers)
            to.sealed.push_back(part.receivers[p]);
}

} // namespace

const char* to_string(LevelMode mode) {
    return mode == LevelMode::carry ? "carry" : mode == LevelMode::own ? "own" : "ignore";
}

ScenePart with_level(const LeveledScene& scene, std::size_t number) {
    std::set<std::size_t> shown;
    for (std::size_t p = 0; p < scene.finest_primitives; ++p)
        shown.insert(p);
    for (const LeveledNode& node : scene.nodes)
        for (const CoarserLevel& level : node.coarser)
            if (static_cast<std::size_t>(level.level) == number) {
                for (const std::size_t p : node.finest)
                    shown.erase(p);
                shown.insert(level.primitives.begin(), level.primitives.end());
            }
    const std::vector<std::size_t> primitives(shown.begin(), shown.end());
    ScenePart part = scene_part(scene.scene, primitives);
    part.scene.images = scene.scene.images;
    return part;
}

LevelBake transfer_of_levels(const LeveledScene& scene, const Transfer& finest, LevelMode mode,
                             const BakeOptions& options, std::span<const std::uint32_t> sealed,
                             const Progress& progress, const FinerModel& finer) {
    return mode == LevelMode::own
               ? bake_levels(scene, finest, options, progress, finer)
               : carry_levels(scene, finest,
                              {.seed = options.seed, .threads = options.threads, .sealed = sealed}, progress);
}

LevelBake bake_levels(const LeveledScene& scene, const Transfer& finest, const BakeOptions& options,
                      const Progress& progress, const FinerModel& finer) {
    const Stopwatch stopwatch;
    LevelBake result;
    result.transfer = zero_transfer(finest.layout, scene.scene.receivers());
    std::ranges::copy(finest.vectors, result.transfer.vectors.begin());
    const std::size_t deepest = scene.deepest();
    for (std::size_t number = 1; number <= deepest; ++number) {
        const ScenePart part = with_level(scene, number);
        const double begin = static_cast<double>(number - 1) / static_cast<double>(deepest),
                     end = static_cast<double>(number) / static_cast<double>(deepest);
        const BakeResult bake =
            prt::bake(part.scene, options, progress.range(begin, end), MeasureErrors::no, finer);
        if (!same_layout(bake.baked.transfer.layout, finest.layout))
            throw Error("level of detail " + std::to_string(number) +
                        " needs transfer with other terms or colors than level 0 and cannot be baked "
                        "separately; use --levels carry");
        copy_level(part, bake, scene.finest_receivers, result);
    }
    for (const LeveledNode& node : scene.nodes)
        for (const CoarserLevel& level : node.coarser) {
            const LevelSamples samples =
                sample_level(scene, node, level, {.seed = options.seed, .threads = options.threads});
            LevelOutcome outcome = outcome_of(scene.scene, node, level, samples);
            outcome.squares = level_error(samples, result.transfer, result.transfer);
            result.levels.push_back(std::move(outcome));
        }
    result.seconds = stopwatch.seconds();
    return result;
}

} // namespace prt
