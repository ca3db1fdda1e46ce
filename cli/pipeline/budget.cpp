// Measures an error budget under each light.

#include "cli/pipeline/budget.h"

#include "prt/bake/bake.h"
#include "prt/core/error.h"
#include "prt/render/lightmap_file.h"
#include "runtime/render/lightmap_lookup.h"

#include <utility>

namespace prt::pipeline {
namespace {

SurfacePoints points_of(const TraceScene& scene, const BudgetEffort& effort, const Progress& progress) {
    SurfacePoints points = surface_points(
        scene, {.count = effort.points, .seed = effort.seed, .threads = effort.threads}, {{}, progress.stop});
    if (points.size() == 0)
        throw Error("no light reaches any surface, so there is no error to measure");
    return points;
}

/// Values of texels as a filter shows them at points.
std::vector<glm::vec3> filtered(const BudgetReference& reference, const LightmapOfFile& lightmap,
                                std::span<const glm::vec3> at_receivers) {
    const SurfacePoints& points = reference.points();
    const LightmapLookup lookup(reference.scene().scene(), lightmap.layout);
    const std::vector<glm::vec3> texels = scatter_to_maps(lightmap.layout, lightmap.texels, at_receivers);
    std::vector<glm::vec3> values;
    for (std::size_t i = 0; i < points.size(); ++i)
        values.push_back(lookup.look_up(points.triangles[i], points.uv[i], texels));
    return values;
}

/// At the points; lamps are off.
std::vector<glm::vec3> radiance_at(const BudgetReference& reference, const Transfer& transfer,
                                   const LightmapOfFile* lightmap, Lighting lighting, int threads) {
    lighting.lamps.assign(transfer.layout.lamps(), glm::vec3(0));
    const std::vector<glm::vec3> radiance = exit_radiance(transfer, lighting, threads);
    return lightmap ? filtered(reference, *lightmap, radiance) : interpolated(reference.points(), radiance);
}

} // namespace

BudgetReference::BudgetReference(const Scene& scene, const std::vector<ReferenceLight>& lights,
                                 const BudgetEffort& effort, const Progress& progress)
    : lights_(lights), scene_(scene, load_textures(scene, effort.bad_textures), {.threads = effort.threads}),
      points_(points_of(scene_, effort, progress)) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const auto count = static_cast<double>(lights.size());
        radiance_.emplace_back(
            scene_, points_, lights[i],
            SurfaceRadianceOptions{.noise = effort.noise,
                                   .seconds = effort.seconds,
                                   .seed = effort.seed,
                                   .threads = effort.threads},
            progress.range(static_cast<double>(i) / count, static_cast<double>(i + 1) / count));
    }
}

double BudgetReference::light_error(int order) const {
    double sum = 0;
    for (std::size_t i = 0; i < lights_.size(); ++i)
        sum += prt::light_error(points_, radiance_[i], cut(i, order, kEndlessBounces)).value;
    return sum / static_cast<double>(lights_.size());
}

double BudgetReference::bounces_error(int bounces) const {
    double sum = 0;
    for (std::size_t i = 0; i < lights_.size(); ++i)
        sum += prt::bounces_error(points_, radiance_[i], cut(i, kMaxOrder, bounces)).value;
    return sum / static_cast<double>(lights_.size());
}

Budgets budgets(const BudgetReference& reference, const BudgetStages& stages, int threads) {
    Budgets all;
    const int order = stages.baked.layout.order;
    for (std::size_t i = 0; i < reference.lights().size(); ++i) {
        const Lighting lighting = reference.lights()[i].lighting(order);
        const auto at_points = [&](const Transfer& transfer) {
            return radiance_at(reference, transfer, stages.lightmap, lighting, threads);
        };
        InterpolatedRadiance radiance{at_points(stages.baked), at_points(stages.repeated), {}, stages.alike};
        radiance.shipped = stages.shipped ? at_points(*stages.shipped) : radiance.baked;
        const BandTruncation cut = reference.cut(i, order, stages.bounces);
        for (const auto& [measure, list] : {std::pair(BudgetMeasure::relative, &all.relative),
                                            std::pair(BudgetMeasure::visible, &all.visible)})
            list->push_back(error_budget(reference.points(), reference.of(i), cut, radiance, measure));
    }
    return all;
}

} // namespace prt::pipeline
