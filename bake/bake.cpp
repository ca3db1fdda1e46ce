// Bakes: plans, traces direct light, finds what is sealed in, propagates light and records what came out.

#include "prt/bake.h"

#include "memory.h"
#include "parts.h"
#include "prt/sh.h"
#include "prt/support/error.h"
#include "prt/support/stopwatch.h"
#include "record.h"
#include "scene/sealed.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

void check_raster_options(const BakeOptions& options) {
    if (options.tracer.backend == Backend::cpu)
        throw Error("method raster draws on the GPU: it has no CPU backend");
    if (options.bounces != 0)
        throw Error("method raster finds direct light only: use method trace for bounces");
    if (options.target_error)
        throw Error(
            "method raster takes the same directions everywhere: use method trace for an error to reach");
    if (options.tracer.raster_resolution < 16 || options.tracer.raster_resolution > 16384)
        throw Error("the resolution of depth maps must lie in 16..16384");
}

void check_options(const BakeOptions& options) {
    check_order(options.order);
    if (options.rays < 1 || options.rays > kMostRays)
        throw Error(fmt::format("rays per receiver must lie in 1..{}, not {}", kMostRays, options.rays));
    if (options.bounces != kEndlessBounces && (options.bounces < 0 || options.bounces > kMostBounces))
        throw Error(
            fmt::format("bounces must lie in 0..{} or be endless, not {}", kMostBounces, options.bounces));
    if (options.target_error && !(*options.target_error > 0 && std::isfinite(*options.target_error)))
        throw Error("the error to reach must be finite and above 0");
    if (!(options.subsurface.metres_per_unit > 0 && std::isfinite(options.subsurface.metres_per_unit)))
        throw Error("metres per unit must be finite and above 0");
    if (options.tracer.method == BakeMethod::raster)
        check_raster_options(options);
}

/// Receivers that are sealed in take the light of their neighbours, where they shall.
SealedIn find_sealed_in(const BakePlan& plan, const Tracer& tracer, const Transfer& direct,
                        const std::stop_token& stop) {
    // Depth maps do not resolve the last hundredth.
    const SealedOptions options{.most_visibility = tracer.method() == BakeMethod::trace ? 0 : 0.01,
                                .seed = plan.options.seed};
    const Sealed sealed = find_sealed(plan.scene, plan.receivers(), direct, options, stop);
    const auto fronts = static_cast<std::ptrdiff_t>(plan.transport->fronts);
    SealedIn found;
    found.rays = sealed.rays;
    found.receivers = static_cast<std::size_t>(
        std::count(sealed.receivers.begin(), sealed.receivers.begin() + fronts, true));
    if (found.receivers > 0 && plan.options.inside == Inside::refill)
        found.refill = Refill(MeshNeighbours(plan.scene.surfaces(), plan.receivers(), plan.transport->fronts),
                              sealed.receivers);
    return found;
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

    DirectLight direct = trace_direct(plan, *tracer, progress.part(0, plan.bounces != 0 ? 0.85 : 0.95));
    const SealedIn sealed = find_sealed_in(plan, *tracer, direct.transfer, progress.stop);
    seconds.tracing = tracer->seconds();

    const Stopwatch transport;
    Propagated exit = propagate_all(
        plan, std::move(direct.transfer),
        {sealed.refill, plan.diffusion, direct.gather ? &*direct.gather : nullptr}, progress.part(0.95, 1));
    seconds.transport = transport.seconds();

    BakeResult result = record(plan, *tracer, direct, sealed, std::move(exit));
    seconds.all = all.seconds();
    result.statistics.seconds = seconds;
    result.statistics.rays_per_second = static_cast<double>(result.statistics.rays) / seconds.all;
    progress.update(1);
    return result;
}

} // namespace prt
