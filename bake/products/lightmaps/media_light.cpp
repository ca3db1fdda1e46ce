// Bakes incident light at vertices of the media alone, as of a scene that a detailed model replaces.

#include "bake/products/lightmaps/media_light.h"

#include "bake/pipeline/direct_transfer.h"
#include "bake/pipeline/outgoing_transfer.h"
#include "bake/plan/memory.h"
#include "bake/plan/transfer_terms.h"
#include "bake/refine/even_refinement.h"
#include "bake/scene/scene_part.h"
#include "prt/core/sh.h"

#include <utility>

namespace prt {
namespace {

/// Returns the primitives of `scene` with a medium, without textures: rays hit other surfaces.
Scene media_of(const Scene& scene, const Media& media) {
    std::vector<std::size_t> primitives;
    for (std::size_t p = 0; p < scene.primitives.size(); ++p)
        if (media[scene.primitives[p].material])
            primitives.push_back(p);
    Scene part = scene_part(scene, primitives).scene;
    part.materials.assign(part.materials.size(), {});
    return part;
}

} // namespace

MediaLight::MediaLight(const BakePlan& plan, DetailedPlan& traced, const BounceSources& lit,
                       const Media& media, double spacing, Tracer& tracer, const Progress& progress)
    : surfaces_(plan.scene.surfaces()), body_of_(bodies_of(plan.scene.scene(), media)),
      options_(plan.options), scene_(with_short_edges(media_of(plan.scene.scene(), media), spacing)),
      own_(trace_scene(scene_, media, options_)), plan_(plan_bake(own_, media, options_, &traced)) {
    check_memory(plan_);
    options_.fit = FitMode::vertex; // vertices are as near to each other as samples of a fit
    BakeStatistics asked;
    Measured measured = measure(plan_, tracer, LastOfLamps::as_others, asked, progress.range(0, 0.9),
                                lit.known_connections());
    rays_ = measured.direct.rays + measured.sealed.rays + measured.lamps.light.rays;
    visible_ = static_cast<float>(measured.direct.mean_visibility * kY00);
    TransportOperators operators{.refill = measured.sealed.refill,
                                 .diffusion = {}, // light that arrives
                                 .gather = measured.direct.gather ? &*measured.direct.gather : nullptr,
                                 .sources = &lit.sky};
    Transfer direct = plan_.channels == 3 ? in_color(measured.direct.transfer) : measured.direct.transfer;
    sky_ = propagate(std::move(direct), operators, plan_.bounces, options_.threads, {{}, progress.stop})
               .transfer;
    if (plan_.lamps.empty())
        return;
    operators.sources = &lit.lamps;
    BakeNoise noise;
    const std::vector<bool> none(plan_.receivers().size());
    lamps_ = propagate_lamps(plan_, measured, operators, {.left_out = &none, .noise = &noise},
                             progress.range(0.9, 1))
                 .transfer;
}

MediaLight::Exit MediaLight::exit(std::size_t body, std::span<const glm::dvec3> positions) const {
    const auto scatter = [&](const Transfer& light) {
        return light.vectors.empty()
                   ? std::vector<float>()
                   : plan_.diffusion[body].at(positions, light.layout.channels(), light.layout.order,
                                              light.vectors, options_.threads);
    };
    return {scatter(sky_), scatter(lamps_)};
}

} // namespace prt
