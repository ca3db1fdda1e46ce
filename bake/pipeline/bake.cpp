// Runs a bake: plans, traces direct light, finds sealed receivers, propagates light and records the result.

#include "prt/bake/bake.h"

#include "bake/pipeline/bounce_sources.h"
#include "bake/pipeline/direct_transfer.h"
#include "bake/pipeline/error_check.h"
#include "bake/pipeline/outgoing_transfer.h"
#include "bake/plan/check_options.h"
#include "bake/plan/memory.h"
#include "bake/plan/transfer_terms.h"
#include "bake/scene/positions_without_area.h"
#include "bake/tracers/make_tracer.h"
#include "runtime/core/support/stopwatch.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace prt {
namespace {

/// Traces points of the surface if the plan measures errors. The points also estimate the sampling error of
/// direct light at receivers.
std::optional<ErrorCheck> check_errors(const BakePlan& plan, Tracer& tracer, Measured& measured,
                                       const std::stop_token& stop) {
    if (!plan.measures_errors)
        return std::nullopt;
    std::optional<ErrorCheck> check(std::in_place, plan, tracer, measured, stop);
    measured.direct.rays += check->rays();
    if (!measured.fit && !plan.options.target_error && tracer.method() == BakeMethod::trace)
        measured.direct.sampling_error =
            check->sampling_error() * noise_left(plan, measured.shared->left(plan.receivers().size()));
    return check;
}

/// Marks receivers whose light is not gathered by their own rays: receivers inside geometry and on media.
std::vector<bool> not_told_by_rays(const BakePlan& plan, const SealedIn& sealed) {
    std::vector<bool> out(plan.receivers().size());
    for (const std::uint32_t p : sealed.receivers)
        out[p] = true;
    for (const DiffusionOperator& body : plan.diffusion)
        for (const std::uint32_t p : body.members())
            out[p] = true;
    return out;
}

/// Exit transfer after all bounces, with lamps in the same vectors.
struct OutgoingTransfer {
    Propagated all;
    ErrorCheck::Bounced at_points;
    BakeNoise noise;
};

/// Propagates measured light. `points`: gathers at the points where errors are measured; may be null.
/// `sources`: light of the detailed model of the plan, if it has one.
OutgoingTransfer outgoing_transfer(const BakePlan& plan, Measured& measured, TransportOperators operators,
                                   const GatherOperator* points, const BounceSources& sources,
                                   const Progress& progress) {
    const std::vector<bool> left_out = not_told_by_rays(plan, measured.sealed);
    std::optional<NoiseFilter> filter;
    if (measured.direct.half)
        filter.emplace(vertex_filter(plan, *measured.shared, left_out));
    OutgoingTransfer exit;
    exit.noise.filtered = filter.has_value();
    const OptionalWork optional_work{
        .points = points, .filter = filter ? &*filter : nullptr, .left_out = &left_out, .noise = &exit.noise};
    const auto at_points = [](Propagated& light) {
        return light.optional_work.empty() ? std::vector<float>() : std::move(light.optional_work.front());
    };
    operators.sources = plan.detail ? &sources.sky : nullptr;
    exit.all = propagate_all(plan, measured, operators, optional_work, progress);
    if (plan.detail && operators.gather)
        exit.all.bounces = sources.bounces;
    exit.at_points.sky = at_points(exit.all);
    if (plan.lamps.empty())
        return exit;
    operators.sources = plan.detail ? &sources.lamps : nullptr;
    Propagated lit = propagate_lamps(plan, measured, operators, optional_work, {{}, progress.stop});
    exit.all.transfer = with_lamps(exit.all.transfer, lit.transfer, plan.lamps);
    exit.all.bounces = std::max(exit.all.bounces, lit.bounces);
    exit.all.remaining = std::max(exit.all.remaining, lit.remaining);
    exit.at_points.lamps = at_points(lit);
    return exit;
}

/// Checks the detailed model, and computes the light that leaves it before the last bounce.
BounceSources detailed_sources(const DetailedPlan& detail, Tracer& tracer, BakePlan& plan,
                               const Progress& progress) {
    if (std::optional<std::string> notice = detail.surface->check())
        plan.notices.push_back(std::move(*notice));
    check_memory(detail.plan);
    return bounce_sources(detail.plan, tracer, progress);
}

} // namespace

BakeResult bake(const Scene& scene, const BakeOptions& options, const Progress& progress,
                MeasureErrors errors, const FinerModel& finer) {
    check_options(options);
    check_finer(finer);
    const Media media = choose_media(scene, options, finer.scene);
    const TraceScene own = trace_scene(scene, media, options);
    std::optional<DetailedPlan> detail;
    if (finer.scene)
        detail.emplace(scene, finer, options);
    BakeStatistics::Seconds seconds;
    const Stopwatch all;
    BakePlan plan = plan_bake(own, media, options, detail ? &*detail : nullptr);
    plan.measures_errors = errors == MeasureErrors::yes;
    check_memory(plan);
    const std::unique_ptr<Tracer> tracer = make_tracer(plan.traced().scene, options.tracer);
    seconds.build = all.seconds();

    const double traced_sky = plan.bounces != 0 ? 0.85 : 0.95, lit = detail && plan.bounces != 0 ? 0.4 : 0;
    const BounceSources sources =
        detail ? detailed_sources(*detail, *tracer, plan, progress.range(0, lit)) : BounceSources();
    BakeStatistics asked;
    Measured measured = measure(plan, *tracer, LastOfLamps::connected, asked, progress.range(lit, traced_sky),
                                sources.known_connections());
    DirectLight& direct = measured.direct;
    const SealedIn& sealed = measured.sealed;
    direct.rays += measured.lamps.light.rays + asked.rays + sources.rays;
    std::optional<ErrorCheck> check = check_errors(plan, *tracer, measured, progress.stop);
    seconds.tracing = tracer->seconds();

    const Stopwatch transport;
    const std::unique_ptr<GatherProduct> product =
        direct.gather && !detail ? tracer->gather_product(*direct.gather) : nullptr;
    const TransportOperators operators{.refill = sealed.refill,
                                       .diffusion = plan.diffusion,
                                       .gather = direct.gather ? &*direct.gather : nullptr,
                                       .product = product.get(),
                                       .fit = measured.fit ? &*measured.fit : nullptr};
    OutgoingTransfer exit = outgoing_transfer(plan, measured, operators, check ? check->gather() : nullptr,
                                              sources, progress.range(traced_sky, 1));
    if (exit.noise.sky > 0)
        direct.sampling_error = exit.noise.sky;
    if (measured.shared)
        measured.shared->average(exit.all.transfer);
    fill_without_area(plan.receivers(), plan.transport->fronts, exit.all.transfer);
    seconds.transport = transport.seconds();

    std::optional<BakeErrors> found =
        check ? std::optional(check->compare(exit.all.transfer, exit.at_points)) : std::nullopt;
    BakeResult result = record(plan, *tracer, direct, sealed, std::move(exit.all));
    result.statistics.fit = asked.fit;
    result.noise = std::move(exit.noise);
    result.errors = std::move(found);
    result.statistics.gather.bytes_moved = product ? product->bytes_moved() : 0;
    result.baked.record.fitted = measured.fit.has_value();
    result.baked.record.media = added_media(scene, media);
    seconds.all = all.seconds();
    result.statistics.seconds = seconds;
    progress.update(1);
    return result;
}

} // namespace prt
