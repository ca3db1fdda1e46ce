// Measures the error budget of a bake and its shipped file.

#include "cli/pipeline/measure_budget.h"

#include "bake/studies/repeated_bake.h"
#include "cli/pipeline/advice.h"
#include "cli/pipeline/budget_report.h"
#include "cli/pipeline/no_shadow.h"
#include "cli/pipeline/solid_materials.h"
#include "prt/bake/bake.h"
#include "prt/core/error.h"
#include "prt/render/lightmap_file.h"

#include <fmt/core.h>

namespace prt::pipeline {
namespace {

/// Repeats a bake with another seed.
Transfer repeat(const SceneFile& baked, int threads, const Progress& progress) {
    if (!baked.lightmap)
        return repeated_bake(baked.scene, baked.baked->transfer, *baked.record(), threads, progress);
    const LightmapOfFile& lightmap = *baked.lightmap;
    return repeated_lightmap(
        baked.scene, {lightmap.layout, lightmap.texels, lightmap.areas, {}, *baked.baked}, threads, progress);
}

void measure(const BudgetRequest& request, const SceneFile& baked, const SceneFile* shipped, Report& report,
             const Host& host) {
    const int threads = request.lights.threads;
    const BakeRecord& record = *baked.record();
    const Stage stage = host.stages("measuring the error budget");
    const Progress progress = stage.progress;
    const std::vector<ReferenceLight> lights = budget_lights(request.lights);
    const Transfer repeated = repeat(baked, threads, progress.range(0, 0.4));
    const BudgetEffort effort{.bad_textures = request.reading.bad_textures, .threads = threads};
    const BudgetReference reference(baked.scene, lights, effort, progress.range(0.4, 0.8));
    std::optional<Transfer> coded;
    if (shipped)
        coded = decode(baked.lightmap ? gather_texels(shipped->compressed->transfer, baked.lightmap->texels)
                                      : shipped->compressed->transfer,
                       threads);
    const Budgets all = budgets(reference,
                                {.baked = baked.baked->transfer,
                                 .repeated = repeated,
                                 .shipped = coded ? &*coded : nullptr,
                                 .bounces = record.endless ? kEndlessBounces : record.bounces,
                                 .lightmap = baked.lightmap ? &*baked.lightmap : nullptr},
                                threads);
    const ErrorBudget mean = mean_budget(all.relative), visible_mean = mean_budget(all.visible);
    const std::optional<Advice> what =
        advice({.reference = reference, .baked = baked, .shipped = shipped, .effort = effort}, mean,
               progress.range(0.8, 1));
    std::vector<Table> tables = budget_tables(lights, all);
    const std::string words = budget_in_words(mean, visible_mean, lights.size());
    Table& first = tables.front();
    first.about = fmt::format("Over the surface: {}; {}. {}", words, advice_in_words(what), first.about);
    report.tables.insert(report.tables.begin(), tables.begin(), tables.end());
    add_figures(report, {{"surface_error", words}});
    add_advice(what, report);
}

} // namespace

void add_budget(BudgetRequest request, SceneFile& baked, Report& report, const Host& host) {
    about(request.baked, [&] {
        check_no_media(baked.scene, solid_materials(baked.scene));
        leave_out_shadows(baked.scene, request.no_shadow);
    });
    std::optional<SceneFile> shipped;
    if (!request.shipped.empty())
        shipped = load_scene_file(request.shipped, request.reading);
    if (shipped)
        check_belong_together(baked, request.baked, *shipped, request.shipped.path);
    if (shipped && !shipped->compressed)
        throw Error(request.shipped.string() +
                    ": is not compressed; an error budget needs a bake and its compressed file");
    const TransferLayout& layout = shipped ? layout_of(*shipped) : layout_of(baked);
    request.lights.order = baked.order();
    request.lights.separate = layout.has(TermKind::direct);
    about(request.baked, [&] { measure(request, baked, shipped ? &*shipped : nullptr, report, host); });
}

} // namespace prt::pipeline
