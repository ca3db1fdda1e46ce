// Traces the gather operator (docs/math.md, section 7), grouping receivers by their number of rays.

#include "bake/pipeline/trace_gather.h"

#include "bake/pipeline/direct.h"
#include "bake/plan/memory.h"
#include "bake/trace/trace_receivers.h"

#include <algorithm>

namespace prt {
namespace {

struct GatherEstimate {
    double bytes = 0;
    std::size_t rays = 0; ///< rays of the estimate
};

/// Estimates the bytes of the rows of all `indices` from some rays of some of them.
GatherEstimate estimate_gather(const BakePlan& plan, Tracer& tracer, std::uint32_t rays,
                               const Receivers& receivers, std::span<const std::uint32_t> indices,
                               const std::stop_token& stop) {
    const std::size_t count = std::min<std::size_t>(64, indices.size());
    std::vector<std::uint32_t> some;
    for (std::size_t i = 0; i < count; ++i)
        some.push_back(indices[i * indices.size() / count]);
    GatherOperator rows = plan.gather_rows(receivers.size());
    const auto empty = static_cast<double>(rows.bytes());
    TraceOptions options = gather_options(plan, std::min(rays, 4096u));
    options.order = 1;
    Transfer unused = zero_transfer(1, 1, receivers.size());
    trace_receivers(tracer.rays(), receivers, some, options, unused, {{}, stop},
                    [&](std::uint32_t p, std::span<const Hit> hits) { rows.set_row(p, hits, options.rays); });
    const double bytes = empty + (static_cast<double>(rows.bytes()) - empty) *
                                     static_cast<double>(indices.size()) / static_cast<double>(count) * rays /
                                     options.rays;
    return {bytes, count * static_cast<std::size_t>(options.rays)};
}

} // namespace

TraceOptions gather_options(const BakePlan& plan, std::uint32_t rays) {
    return {.order = plan.options.order,
            .rays = static_cast<int>(rays),
            .seed = plan.options.seed,
            .hit_stride = kHitStride};
}

std::size_t check_gather_memory(const BakePlan& plan, Tracer& tracer, const Receivers& receivers,
                                const ByRays& by_rays, double copies, const std::stop_token& stop) {
    double most = 0, likely = 0;
    std::size_t traced = 0;
    for (const auto& [rays, members] : by_rays)
        most += static_cast<double>(members.size()) * rays * GatherOperator::kMaxBytesPerRay;
    // A ray can hit any number of blended surfaces.
    if (!plan.traced().scene.surfaces().traits().alpha && fits_memory(plan, most * copies))
        return 0;
    for (const auto& [rays, members] : by_rays) {
        const GatherEstimate estimate = estimate_gather(plan, tracer, rays, receivers, members, stop);
        likely += estimate.bytes;
        traced += estimate.rays;
    }
    check_memory(plan, likely * copies);
    return traced;
}

TracedGather trace_gather(const BakePlan& plan, Tracer& tracer, const LampConnections* lamps,
                          std::span<const std::uint32_t> rays_of, Transfer& transfer, HalfOfRays* half,
                          const Progress& progress) {
    const Receivers& receivers = plan.transport->measured();
    ByRays by_rays;
    std::size_t all = 0, done = 0;
    for (const std::uint32_t p : receivers_on_surfaces(receivers)) {
        by_rays[rays_of[p]].push_back(p);
        all += rays_of[p];
    }
    const double copies = 1 + (lamps ? LampRows::kCopies : 0) + (half ? 0.5 : 0);
    TracedGather traced{plan.gather_rows(receivers.size()), std::nullopt,
                        all + check_gather_memory(plan, tracer, receivers, by_rays, copies, progress.stop)};
    if (lamps)
        traced.lamps.emplace(plan, receivers.size(), half != nullptr);
    if (half)
        half->gather.emplace(plan.gather_rows(receivers.size()));
    const auto share = [&](std::size_t rays) { return static_cast<double>(rays) / static_cast<double>(all); };
    for (const auto& [rays, members] : by_rays) {
        const TraceOptions options = gather_options(plan, rays);
        const std::size_t here = members.size() * rays;
        const Progress term = progress.range(share(done), share(done + here));
        const auto set_rows = [&](std::uint32_t p, std::span<const Hit> hits) {
            traced.gather.set_row(p, hits, options.rays);
            if (lamps)
                traced.lamps->set(p, lamps->join(receivers, p, hits, options), options.rays);
        };
        if (half && first_half(options.rays) > 0)
            trace_in_halves(tracer, receivers, members, options, {transfer, half->direct}, term,
                            [&](std::uint32_t p, std::span<const Hit> hits, std::span<const Hit> first) {
                                set_rows(p, hits);
                                half->gather->set_row(p, first, first_half(options.rays));
                            });
        else
            trace_receivers(tracer, receivers, members, options, transfer, term, set_rows);
        done += here;
    }
    return traced;
}

} // namespace prt
