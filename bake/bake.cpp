// Bakes: plans, traces direct light, finds what is sealed in, propagates light and records what came out.

#include "prt/bake.h"

#include "bake_options.h"
#include "error_check.h"
#include "exit_light.h"
#include "measured_light.h"
#include "memory.h"
#include "parts.h"
#include "prt/support/stopwatch.h"
#include "scene/places_without_area.h"

#include <algorithm>
#include <memory>

namespace prt {

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
    MeasuredLamps lamps = measure_lamps(plan, *tracer, measured.fit, progress.part(traced_all, traced_sky));
    direct.rays += lamps.light.rays + asked.rays;
    std::optional<ErrorCheck> check;
    if (options.measure_errors) {
        check.emplace(plan, *tracer, measured, lamps, progress.stop);
        direct.rays += check->rays();
        if (!measured.fit && !options.target_error && tracer->method() == BakeMethod::trace)
            direct.sampling_error = check->sampling_error();
    }
    seconds.tracing = tracer->seconds();

    const Stopwatch transport;
    const std::unique_ptr<GatherProduct> product =
        direct.gather ? tracer->gather_product(*direct.gather) : nullptr;
    const TransportOperators operators{.refill = sealed.refill,
                                       .diffusion = plan.diffusion,
                                       .gather = direct.gather ? &*direct.gather : nullptr,
                                       .product = product.get(),
                                       .fit = measured.fit ? &*measured.fit : nullptr,
                                       .check = check ? check->gather() : nullptr};
    Propagated exit = propagate_all(plan, std::move(direct.transfer), measured.sky, operators,
                                    progress.part(traced_sky, 1));
    Propagated lit;
    if (!plan.lamps.empty()) {
        lit = propagate_lamps(plan, std::move(lamps), operators, progress.part(1, 1));
        exit.transfer = with_lamps(exit.transfer, lit.transfer, plan.lamps);
        exit.bounces = std::max(exit.bounces, lit.bounces);
        exit.remaining = std::max(exit.remaining, lit.remaining);
    }
    fill_without_area(plan.receivers(), plan.transport->fronts, exit.transfer);
    seconds.transport = transport.seconds();

    if (check)
        asked.errors = check->compare(exit.transfer, {.sky = exit.at_check, .lamps = lit.at_check});

    BakeResult result = record(plan, *tracer, direct, sealed, std::move(exit));
    result.statistics.fit = asked.fit;
    result.statistics.errors = std::move(asked.errors);
    result.statistics.gather.bytes_moved = product ? product->bytes_moved() : 0;
    result.baked.record.fitted = measured.fit.has_value();
    seconds.all = all.seconds();
    result.statistics.seconds = seconds;
    progress.update(1);
    return result;
}

} // namespace prt
