// Measures light before it bounces: at receivers or over the surface between them, and what is sealed in.

#include "measured_light.h"

#include "scene/sealed.h"
#include "surface/fit_choice.h"
#include "surface/fitted_light.h"

#include <algorithm>

namespace prt {
namespace {

/// Receivers that are sealed in take the light of their neighbours, where they shall.
SealedIn find_sealed_in(const BakePlan& plan, Tracer& tracer, const Transfer& direct,
                        const std::stop_token& stop) {
    // Depth maps do not resolve the last hundredth.
    const double darkest = tracer.method() == BakeMethod::trace ? 0 : 0.01 * kY00;
    std::vector<std::uint32_t> dark;
    for (const std::uint32_t p : receivers_on_surfaces(plan.receivers()))
        if (static_cast<double>(direct.vector(p)[0]) <= darkest)
            dark.push_back(p);
    const Sealed sealed =
        find_sealed(tracer, plan.scene, plan.receivers(), std::move(dark), plan.options.seed, stop);
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

/// Asks points between vertices whether to fit, where that is not said.
FitChoice fit_choice(const BakePlan& plan, Tracer& tracer, BakeStatistics& statistics,
                     const Progress& progress) {
    const BakeOptions& options = plan.options;
    const bool possible = tracer.method() == BakeMethod::trace && !options.target_error;
    if (options.fit == FitMode::vertex || !possible)
        return {};
    const FitTrial trial = try_fit(plan, tracer, progress);
    FitChoice choice = choose_fit(trial, options.rays);
    choice.better = choice.better || options.fit == FitMode::surface;
    statistics.fit = {
        .samples = choice.better ? choice.samples : 0, .between = trial.between, .sampling = trial.sampling};
    statistics.rays += trial.rays;
    return choice;
}

} // namespace

Measured measure(const BakePlan& plan, Tracer& tracer, BakeStatistics& statistics, const Progress& progress) {
    const FitChoice choice = fit_choice(plan, tracer, statistics, progress.part(0, 0.03));
    if (choice.better) {
        FittedLight fitted = trace_fitted(plan, tracer, choice.samples, progress.part(0.03, 1));
        return {std::move(fitted.direct), std::move(fitted.sealed), std::move(fitted.fit),
                std::move(fitted.sky)};
    }
    SharedPlaces shared(plan.scene, *plan.transport);
    const std::vector<float> left = shared.left(plan.receivers().size());
    Measured measured{
        trace_direct(plan, tracer, left, progress.part(0.03, 1)), {}, {}, {}, std::move(shared)};
    measured.sealed = find_sealed_in(plan, tracer, measured.direct.transfer, progress.stop);
    return measured;
}

MeasuredLamps measure_lamps(const BakePlan& plan, Tracer& tracer, const std::optional<SurfaceFit>& fit,
                            const Progress& progress) {
    LampTask task{.scene = plan.scene,
                  .receivers = fit ? fit->samples.receivers : plan.receivers(),
                  .lamps = plan.lamps,
                  .options = plan.options.lamps,
                  .channels = plan.lamp_channels(),
                  .seed = plan.options.seed,
                  .threads = plan.options.threads};
    if (!fit)
        return {tracer.lamp_light(task, progress), {}};
    task.options.rays = std::max(1, task.options.rays / static_cast<int>(fit->samples.layers));
    LampLight at_samples = tracer.lamp_light(task, progress);
    MeasuredLamps lamps{{zero_transfer(at_samples.transfer.layout, plan.receivers().size()), at_samples.rays},
                        {}};
    const std::size_t stride = at_samples.transfer.dimension();
    const TestValues tests = TestValues::of_lamps(plan.lamps.size(), task.channels,
                                                  stride / static_cast<std::size_t>(task.channels));
    lamps.sampled = {.stride = stride,
                     .tests = tests.count(),
                     .sums = std::vector<float>(fit->equations.unknowns * stride),
                     .sharp = {},
                     .values = std::vector<float>(fit->samples.size() * tests.count())};
    add_samples(fit->equations, 0, std::span<const float>(at_samples.transfer.vectors), stride,
                std::span(lamps.sampled.sums));
    for (std::size_t s = 0; s < fit->samples.size(); ++s)
        tests.evaluate(at_samples.transfer.vector(s),
                       std::span(lamps.sampled.values).subspan(s * tests.count(), tests.count()));
    std::vector<float> smooth = lamps.sampled.sums;
    fit->smooth(std::span(smooth), stride);
    spread_unknowns(fit->equations, std::span<const float>(smooth), stride,
                    std::span(lamps.light.transfer.vectors));
    return lamps;
}

} // namespace prt
