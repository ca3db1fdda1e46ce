// Bakes: plans, traces direct light, finds what is sealed in, propagates light and records what came out.

#include "prt/bake.h"

#include "bake_options.h"
#include "error_check.h"
#include "exit_light.h"
#include "lamps/lamp_bounces.h"
#include "measured_light.h"
#include "memory.h"
#include "parts.h"
#include "prt/support/stopwatch.h"
#include "scene/places_without_area.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace prt {
namespace {

/// Traces points of the surface where the plan measures errors. They also estimate the sampling error of
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

/// Gathers light at the points of the error check, then by the rows of lamps.
struct GatheredBeside {
    std::optional<GatherOperator> gather;
    std::size_t points = 0; ///< rows of the check
    std::optional<LampBounces> lamps;

    GatheredBeside(const BakePlan& plan, Measured& measured, std::optional<ErrorCheck>& check) {
        if (check)
            if (std::optional<GatherOperator> rows = check->take_gather()) {
                points = rows->rows();
                gather.emplace(std::move(*rows));
            }
        std::optional<LampRows>& rows = measured.direct.lamps;
        if (!rows || measured.fit)
            return;
        if (gather)
            gather->append(std::move(rows->all));
        else
            gather.emplace(std::move(rows->all));
        if (rows->half)
            gather->append(std::move(*rows->half));
        std::vector<bool> sealed(plan.receivers().size());
        for (const std::uint32_t p : measured.sealed.receivers)
            sealed[p] = true;
        lamps.emplace(plan, *measured.shared, std::move(sealed), points);
    }
    std::span<const float> at_points(std::span<const float> light) const {
        return light.first(gather ? light.size() / gather->rows() * points : 0);
    }
};

/// Exit light of the sky, and of lamps in the same transfer.
struct ExitLight {
    Propagated all;
    std::vector<float> lamps_at_check; ///< as Propagated::at_check
};

ExitLight exit_light(const BakePlan& plan, Measured& measured, const TransportOperators& operators,
                     const Progress& progress) {
    ExitLight exit{
        propagate_all(plan, std::move(measured.direct.transfer), measured.sky, operators, progress), {}};
    if (plan.lamps.empty())
        return exit;
    Propagated lit = propagate_lamps(plan, std::move(measured.lamps), operators, {{}, progress.stop});
    exit.all.transfer = with_lamps(exit.all.transfer, lit.transfer, plan.lamps);
    exit.all.bounces = std::max(exit.all.bounces, lit.bounces);
    exit.all.remaining = std::max(exit.all.remaining, lit.remaining);
    exit.lamps_at_check = std::move(lit.at_check);
    return exit;
}

} // namespace

BakeResult bake(const Scene& scene, const BakeOptions& options, const Progress& progress,
                MeasureErrors errors) {
    check_options(options);
    const Media media = choose_media(scene, options);
    const TraceScene traced = trace_scene(scene, media, options);
    BakeStatistics::Seconds seconds;
    const Stopwatch all;
    BakePlan plan = plan_bake(traced, media, options);
    plan.measures_errors = errors == MeasureErrors::yes;
    check_memory(plan);
    const std::unique_ptr<Tracer> tracer = make_tracer(traced, options.tracer);
    seconds.build = all.seconds();

    const double traced_sky = plan.bounces != 0 ? 0.85 : 0.95;
    BakeStatistics asked;
    Measured measured = measure(plan, *tracer, LastOfLamps::connected, asked, progress.part(0, traced_sky));
    DirectLight& direct = measured.direct;
    const SealedIn& sealed = measured.sealed;
    direct.rays += measured.lamps.light.rays + asked.rays;
    std::optional<ErrorCheck> check = check_errors(plan, *tracer, measured, progress.stop);
    seconds.tracing = tracer->seconds();

    const Stopwatch transport;
    const std::unique_ptr<GatherProduct> product =
        direct.gather ? tracer->gather_product(*direct.gather) : nullptr;
    const GatheredBeside beside(plan, measured, check);
    const TransportOperators operators{.refill = sealed.refill,
                                       .diffusion = plan.diffusion,
                                       .gather = direct.gather ? &*direct.gather : nullptr,
                                       .product = product.get(),
                                       .fit = measured.fit ? &*measured.fit : nullptr,
                                       .check = beside.gather ? &*beside.gather : nullptr,
                                       .lamps = beside.lamps ? &*beside.lamps : nullptr,
                                       .last_of_lamps =
                                           measured.fit && direct.lamps ? &direct.lamps->all : nullptr};
    ExitLight exit = exit_light(plan, measured, operators, progress.part(traced_sky, 1));
    if (measured.shared)
        measured.shared->average(exit.all.transfer);
    fill_without_area(plan.receivers(), plan.transport->fronts, exit.all.transfer);
    seconds.transport = transport.seconds();

    std::optional<BakeErrors> found;
    if (check)
        found = check->compare(exit.all.transfer, {.sky = beside.at_points(exit.all.at_check),
                                                   .lamps = beside.at_points(exit.lamps_at_check)});

    BakeResult result = record(plan, *tracer, direct, sealed, std::move(exit.all));
    result.statistics.fit = asked.fit;
    result.statistics.lamps.denoised = beside.lamps && beside.lamps->filters();
    result.errors = std::move(found);
    result.statistics.gather.bytes_moved = product ? product->bytes_moved() : 0;
    result.baked.record.fitted = measured.fit.has_value();
    seconds.all = all.seconds();
    result.statistics.seconds = seconds;
    progress.update(1);
    return result;
}

} // namespace prt
