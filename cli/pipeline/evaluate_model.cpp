// Measures errors of a compressed file or of a bake.

#include "cli/pipeline/evaluate_model.h"

#include "cli/pipeline/comparison.h"
#include "cli/pipeline/evaluation_lights.h"
#include "cli/pipeline/level_errors.h"
#include "cli/pipeline/measure_budget.h"
#include "cli/pipeline/volume_errors.h"
#include "cli/report/of_texels.h"
#include "cli/report/sweep_report.h"
#include "prt/core/error.h"

namespace prt::pipeline {
namespace {

Sweep run_sweep(const EvaluateRequest& a, const SceneFile& baked, const std::vector<LoadedLight>& lights,
                const Host& host) {
    std::vector<Light> all;
    for (const LoadedLight& light : lights)
        all.push_back(light.combined);
    CompressOptions options;
    options.threads = a.threads;
    const Stage stage = host.stages("sweeping");
    const Transfer& transfer = baked.baked->transfer;
    const std::optional<SceneSurface> vertices =
        baked.lightmap ? std::nullopt : std::optional<SceneSurface>(baked.scene);
    const ReceiverSurface surface =
        vertices ? vertices->view() : ReceiverSurface{baked.lightmap->areas, baked.lightmap->edges};
    return sweep(transfer, surface, all, options, {}, stage.progress);
}

/// Returns the named lights, rotated as requested, or the default ones.
std::vector<LoadedLight> lights_of(const EvaluateRequest& a, int order) {
    std::vector<LoadedLight> lights;
    for (const Path& path : a.lights)
        for (LoadedLight& light :
             rotations(load_light(path, order, a.suns, a.light_options, a.threads), a.rotations))
            lights.push_back(std::move(light));
    return lights.empty() ? default_lights(order) : lights;
}

void add_sizes_of_bake(const EvaluateRequest& a, const Transfer& transfer, Report& report) {
    report.figures.insert(
        report.figures.end(),
        {{{"receivers", "vertices"}, transfer.receivers()},
         {{"order", "order"}, transfer.layout.order},
         {{"channels", "channels"}, transfer.layout.channels()},
         {{"bytes_baked_per_vertex", "bytes per vertex, bake"}, transfer.dimension() * sizeof(float)},
         {{"bytes_file_baked", "bytes of the file, bake"}, static_cast<std::size_t>(a.baked.size())}});
}

BudgetRequest budget_request(const EvaluateRequest& a) {
    return {.baked = a.baked.path,
            .shipped = a.shipped,
            .reading = a.reading,
            .lights = {.files = a.lights,
                       .suns = a.suns,
                       .reading = a.light_options,
                       .order = {},
                       .separate = {},
                       .threads = a.threads},
            .no_shadow = a.no_shadow};
}

} // namespace

Report evaluate_model(EvaluateRequest a, const Host& host) {
    if (a.rotations < 1 || a.rotations > 64)
        throw Error("the number of rotations must be in 1..64");
    a.reading.leave_out_lobes = true; // prt lobes measures them
    SceneFile baked = load_scene_file(a.baked, a.reading);
    if (!baked.baked)
        throw Error(a.baked.string() +
                    ": contains no raw transfer; the first file must be the output of prt bake");
    if (has_lobes(baked.document) &&
        (a.measures.contains(Measure::budget) || a.measures.contains(Measure::volume)))
        throw Error(a.baked.string() + ": --measure budget and volume do not support files with lobes: they "
                                       "repeat the bake without the vertices that have lobes");
    const std::vector<LoadedLight> lights = lights_of(a, baked.baked->transfer.layout.order);
    Report report;
    if (!a.shipped.empty())
        add_comparison({.baked = a.baked.path,
                        .shipped = a.shipped,
                        .reading = a.reading,
                        .pictures = a.pictures,
                        .threads = a.threads},
                       baked, lights, report);
    if (!a.shipped.empty() && !baked.lightmap)
        add_level_errors({baked.document, a.baked.path, a.shipped, a.reading, a.threads}, lights, report);
    add_sizes_of_bake(a, baked.baked->transfer, report);
    if (a.measures.contains(Measure::budget))
        add_budget(budget_request(a), baked, report, host);
    if (a.measures.contains(Measure::volume))
        add_volume_errors(budget_request(a), baked, report, host);
    if (a.measures.contains(Measure::sweep))
        add_sweep(run_sweep(a, baked, lights, host), report);
    if (baked.lightmap)
        report_texels(report);
    return report;
}

} // namespace prt::pipeline
