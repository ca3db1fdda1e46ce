// Measures light before it bounces, at receivers or over the surface between them, and finds sealed
// receivers.

#include "bake/pipeline/direct_transfer.h"

#include "bake/pipeline/fitted_light.h"
#include "bake/pipeline/lamps_of_plan.h"
#include "bake/surface_fit/fit_choice.h"
#include "bake/trace/sealed.h"

#include <algorithm>

namespace prt {
namespace {

/// Finds sealed receivers. They take the light of their neighbours if the options request it.
SealedIn find_sealed_in(const BakePlan& plan, Tracer& tracer, const Transfer& direct,
                        const std::stop_token& stop) {
    std::vector<std::uint32_t> dark;
    for (const std::uint32_t p : receivers_on_surfaces(plan.receivers()))
        if (static_cast<double>(direct.vector(p)[0]) <= max_dark(tracer))
            dark.push_back(p);
    const Sealed sealed = find_sealed(tracer, plan.traced().scene, plan.transport->measured(),
                                      std::move(dark), plan.options.seed, stop);
    SealedIn found;
    found.rays = sealed.rays;
    for (std::uint32_t p = 0; p < plan.transport->fronts; ++p)
        if (sealed.receivers[p])
            found.receivers.push_back(p);
    if (!found.receivers.empty() && plan.options.repairs.inside == Inside::refill)
        found.refill = Refill(
            MeshNeighbours(plan.scene.surfaces(), plan.receivers(), plan.transport->fronts, sealed.receivers),
            sealed.receivers);
    return found;
}

/// Decides whether to fit; traces test points between vertices if the options leave the choice open.
FitChoice fit_choice(const BakePlan& plan, Tracer& tracer, BakeStatistics& statistics,
                     const Progress& progress) {
    const BakeOptions& options = plan.options;
    const bool compared = tracer.method() == BakeMethod::trace && !options.target_error;
    if (options.fit == FitMode::vertex || (options.fit == FitMode::automatic && !compared))
        return {};
    const FitTrial trial = try_fit(plan, tracer.rays(), progress);
    FitChoice choice = choose_fit(trial, options.rays, options.repairs.denoise);
    choice.better = choice.better || options.fit == FitMode::surface;
    statistics.fit = {
        .samples = choice.better ? choice.samples : 0, .between = trial.between, .sampling = trial.sampling};
    statistics.rays += trial.rays;
    return choice;
}

} // namespace

Measured measure(const BakePlan& plan, Tracer& tracer, LastOfLamps last, BakeStatistics& statistics,
                 const Progress& progress, const LampConnections* known) {
    const FitChoice choice = fit_choice(plan, tracer, statistics, progress.range(0, 0.03));
    if (choice.better) {
        FittedLight fitted = trace_fitted(plan, tracer, last, choice.samples, progress.range(0.03, 1), known);
        return {.direct = std::move(fitted.direct),
                .lamps = std::move(fitted.lamps),
                .sealed = std::move(fitted.sealed),
                .fit = std::move(fitted.fit),
                .sky = std::move(fitted.sky)};
    }
    const double lit = plan.lamps.empty() ? 0.03 : 0.25;
    MeasuredLamps lamps{light_of_lamps(plan, tracer, plan.transport->measured(), {.seed = plan.options.seed},
                                       progress.range(0.03, lit)),
                        {}};
    const std::optional<LampConnections> connections = connections_to(plan, last, lamps.light.transfer);
    SharedPositions shared(plan.scene, *plan.transport);
    DirectLight direct = trace_direct(plan, tracer, connections ? &*connections : known,
                                      shared.left(plan.receivers().size()), progress.range(lit, 1));
    Measured measured{.direct = std::move(direct),
                      .lamps = std::move(lamps),
                      .sealed = {},
                      .fit = {},
                      .sky = {},
                      .shared = std::move(shared)};
    measured.sealed = find_sealed_in(plan, tracer, measured.direct.transfer, progress.stop);
    return measured;
}

} // namespace prt
