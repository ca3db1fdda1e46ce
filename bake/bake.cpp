// Bakes: plans, traces direct light, finds what is sealed in, propagates light and records what came out.

#include "prt/bake.h"

#include "bake_options.h"
#include "lamps/lamp_light.h"
#include "memory.h"
#include "parts.h"
#include "prt/sh.h"
#include "prt/support/error.h"
#include "prt/support/stopwatch.h"
#include "record.h"
#include "scene/sealed.h"
#include "surface/fit_choice.h"
#include "surface/fitted_light.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

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
    const auto fronts = static_cast<std::ptrdiff_t>(plan.transport->fronts);
    SealedIn found;
    found.rays = sealed.rays;
    found.receivers = static_cast<std::size_t>(
        std::count(sealed.receivers.begin(), sealed.receivers.begin() + fronts, true));
    if (found.receivers > 0 && plan.options.repairs.inside == Inside::refill)
        found.refill = Refill(MeshNeighbours(plan.scene.surfaces(), plan.receivers(), plan.transport->fronts),
                              sealed.receivers);
    return found;
}

/// Light as it was measured, and how it becomes that of receivers.
struct Measured {
    DirectLight direct;
    SealedIn sealed;
    std::optional<SurfaceFit> fit; ///< none: measured at receivers
};

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

Measured measure(const BakePlan& plan, Tracer& tracer, BakeStatistics& statistics, const Progress& progress) {
    const FitChoice choice = fit_choice(plan, tracer, statistics, progress.part(0, 0.03));
    if (choice.better) {
        FittedLight fitted = trace_fitted(plan, tracer, choice.samples, progress.part(0.03, 1));
        statistics.fit.factor_entries = fitted.fit.solver.entries();
        return {std::move(fitted.direct), std::move(fitted.sealed), std::move(fitted.fit)};
    }
    Measured measured{trace_direct(plan, tracer, progress.part(0.03, 1)), {}, {}};
    measured.sealed = find_sealed_in(plan, tracer, measured.direct.transfer, progress.stop);
    return measured;
}

/// Light of the plan's lamps at its receivers.
LampLight measure_lamps(const BakePlan& plan, Tracer& tracer, const std::optional<SurfaceFit>& fit,
                        const Progress& progress) {
    LampTask task{.scene = plan.scene,
                  .receivers = fit ? fit->samples.receivers : plan.receivers(),
                  .lamps = plan.lamps,
                  .options = plan.options.lamps,
                  .channels = plan.lamp_channels(),
                  .seed = plan.options.seed,
                  .threads = plan.options.threads};
    if (!fit)
        return tracer.lamp_light(task, progress);
    task.options.rays = std::max(1, task.options.rays / static_cast<int>(fit->samples.layers));
    const LampLight at_samples = tracer.lamp_light(task, progress);
    LampLight light{zero_transfer(at_samples.transfer.layout, plan.receivers().size()), at_samples.rays};
    fit->apply(at_samples.transfer.vectors, light.transfer.vectors, light.transfer.dimension(),
               plan.options.threads);
    for (float& v : light.transfer.vectors) // beside a peak the best fit falls below zero
        v = std::max(v, 0.0f);
    return light;
}

/// Exit transfer of the scene's receivers from that of both sides of its surfaces.
void leave_back_sides(const BakePlan& plan, Transfer& exit) {
    if (plan.scene.surfaces().traits().transmission)
        add_transmission(exit, plan.scene.surfaces(), *plan.transport);
    exit.vectors.resize(plan.transport->fronts * exit.dimension());
}

/// Exit transfer of the scene's receivers in its parts: direct, and all bounces and subsurface scattering.
Propagated propagate_all(const BakePlan& plan, Transfer direct, const TransportOperators& operators,
                         const Progress& progress) {
    Transfer unbounced = exit_without_bounces(plan, direct, operators.refill);
    if (plan.direct_channels() == 3)
        unbounced = in_color(unbounced);
    leave_back_sides(plan, unbounced);
    if (!operators.gather && operators.diffusion.empty())
        return {.transfer = narrowed(std::move(unbounced))};
    if (plan.channels == 3)
        direct = in_color(direct);
    Propagated exit = propagate(std::move(direct), operators, plan.bounces, plan.options.threads, progress);
    leave_back_sides(plan, exit.transfer);
    exit.transfer = in_parts(narrowed(std::move(unbounced)), exit.transfer);
    return exit;
}

/// A lamp in a closed room whose walls reflect all of its light would fill it without end; what the solver
/// then gives means nothing.
void check_has_an_end(const Propagated& lit) {
    float least = 0, most = 0;
    for (const float v : lit.transfer.vectors) {
        least = std::min(least, v);
        most = std::max(most, v);
    }
    if (!lit.converged || least < -1e-2f * most)
        throw Error(
            "the light of lamps has no end: walls of a closed room reflect all of it (a base color of "
            "1); make them darker, or give a number of bounces");
}

/// Exit light of lamps, with all bounces, from what they give without: of the scene's receivers.
Propagated propagate_lamps(const BakePlan& plan, Transfer light, const TransportOperators& operators,
                           const Progress& progress) {
    if (plan.channels == 1 && light.layout.channels() == 3) { // colors one after the other
        Propagated all;
        Transfer colors[3];
        for (int c = 0; c < 3; ++c) {
            Propagated one = propagate_lamps(plan, one_channel(light, c), operators, progress);
            colors[c] = std::move(one.transfer);
            all.bounces = std::max(all.bounces, one.bounces);
            all.remaining = std::max(all.remaining, one.remaining);
        }
        all.transfer = in_color(colors[0], colors[1], colors[2]);
        return all;
    }
    Transfer unbounced;
    if (plan.options.lamps.mode == LampMode::indirect) {
        unbounced = exit_without_bounces(plan, light, operators.refill);
        leave_back_sides(plan, unbounced);
    }
    Propagated exit = propagate(std::move(light), operators, plan.bounces, plan.options.threads, progress);
    leave_back_sides(plan, exit.transfer);
    check_has_an_end(exit);
    const std::size_t stride = static_cast<std::size_t>(coefficient_count(unbounced.layout.order));
    for (std::size_t i = 0; i < unbounced.vectors.size(); ++i)
        if (const std::size_t k = i % stride; k < plan.lamps.size() && !plan.lamps[k].towards)
            exit.transfer.vectors[i] -= unbounced.vectors[i]; // of keys nobody else adds it
    return exit;
}

} // namespace

BakeResult bake(const Scene& scene, const BakeOptions& options, const Progress& progress) {
    check_options(options);
    const Media media = choose_media(scene, options);
    const TraceScene traced = trace_scene(scene, media, options);
    BakeStatistics::Seconds seconds;
    const Stopwatch all;
    const BakePlan plan = plan_bake(traced, media, options);
    check_memory(plan);
    const std::unique_ptr<Tracer> tracer = make_tracer(traced, options.tracer);
    seconds.build = all.seconds();

    const double traced_sky = plan.bounces != 0 ? 0.85 : 0.95,
                 traced_all = plan.lamps.empty() ? traced_sky : traced_sky - 0.2;
    BakeStatistics asked;
    Measured measured = measure(plan, *tracer, asked, progress.part(0, traced_all));
    DirectLight& direct = measured.direct;
    const SealedIn& sealed = measured.sealed;
    LampLight lamps = measure_lamps(plan, *tracer, measured.fit, progress.part(traced_all, traced_sky));
    direct.rays += lamps.rays + asked.rays;
    seconds.tracing = tracer->seconds();

    const Stopwatch transport;
    const std::unique_ptr<GatherProduct> product =
        direct.gather ? tracer->gather_product(*direct.gather) : nullptr;
    const TransportOperators operators{.refill = sealed.refill,
                                       .diffusion = plan.diffusion,
                                       .gather = direct.gather ? &*direct.gather : nullptr,
                                       .product = product.get(),
                                       .fit = measured.fit ? &*measured.fit : nullptr};
    Propagated exit =
        propagate_all(plan, std::move(direct.transfer), operators, progress.part(traced_sky, 1));
    if (!plan.lamps.empty()) {
        const Propagated lit =
            propagate_lamps(plan, std::move(lamps.transfer), operators, progress.part(1, 1));
        exit.transfer = with_lamps(exit.transfer, lit.transfer, plan.lamps);
        exit.bounces = std::max(exit.bounces, lit.bounces);
        exit.remaining = std::max(exit.remaining, lit.remaining);
    }
    seconds.transport = transport.seconds();

    BakeResult result = record(plan, *tracer, direct, sealed, std::move(exit));
    result.statistics.fit = asked.fit;
    result.statistics.gather.bytes_moved = product ? product->bytes_moved() : 0;
    result.baked.record.fitted = measured.fit.has_value();
    seconds.all = all.seconds();
    result.statistics.seconds = seconds;
    progress.update(1);
    return result;
}

} // namespace prt
