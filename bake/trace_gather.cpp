// Traces the gather operator (docs/math.md, section 7), receivers of as many rays together.

#include "trace_gather.h"

#include "memory.h"
#include "prt/trace_receivers.h"

#include <algorithm>
#include <map>

namespace prt {
namespace {

/// One ray of so many is followed for the bounces. Measured on the room with columns, 3 bounces, 1 024 rays:
/// relative L2 2.32 % in 1.53 s and 190 MB with every ray, 2.86 % in 1.04 s and 59 MB with every fourth (0.74
/// s without bounces); more rays would buy that error back in the time that was saved.
constexpr int kHitStride = 4;

/// Receivers by their number of rays.
using ByRays = std::map<std::uint32_t, std::vector<std::uint32_t>>;

TraceOptions gather_options(const BakePlan& plan, std::uint32_t rays) {
    return {.order = plan.options.order,
            .rays = static_cast<int>(rays),
            .seed = plan.options.seed,
            .hit_stride = kHitStride};
}

GatherOperator empty_gather(const BakePlan& plan) {
    return {plan.scene.surfaces(), *plan.transport, plan.channels};
}

struct GatherEstimate {
    double bytes = 0;
    std::size_t rays = 0; ///< traced to find out
};

/// Estimates the bytes of the rows of all `receivers` from some rays of some of them.
GatherEstimate estimate_gather(const BakePlan& plan, Tracer& tracer, std::uint32_t rays,
                               std::span<const std::uint32_t> receivers, const std::stop_token& stop) {
    const std::size_t count = std::min<std::size_t>(64, receivers.size());
    std::vector<std::uint32_t> some;
    for (std::size_t i = 0; i < count; ++i)
        some.push_back(receivers[i * receivers.size() / count]);
    GatherOperator rows = empty_gather(plan);
    const auto empty = static_cast<double>(rows.bytes());
    TraceOptions options = gather_options(plan, std::min(rays, 4096u));
    options.order = 1;
    Transfer unused = zero_transfer(1, 1, plan.receivers().size());
    trace_receivers(tracer, plan.receivers(), some, options, unused, {{}, stop},
                    [&](std::uint32_t p, std::span<const Hit> hits) { rows.set_row(p, hits, options.rays); });
    const double bytes = empty + (static_cast<double>(rows.bytes()) - empty) *
                                     static_cast<double>(receivers.size()) / static_cast<double>(count) *
                                     rays / options.rays;
    return {bytes, count * static_cast<std::size_t>(options.rays)};
}

/// Asks whether the rows of the gather fit: by what there can be at most, else by what some receivers see.
/// Returns how many rays were traced.
std::size_t check_gather_memory(const BakePlan& plan, Tracer& tracer, const ByRays& by_rays,
                                const std::stop_token& stop) {
    double most = 0, likely = 0;
    std::size_t traced = 0;
    for (const auto& [rays, members] : by_rays)
        most += static_cast<double>(members.size()) * rays * GatherOperator::kMostBytesPerRay;
    // Through blended surfaces a ray meets any number.
    if (!plan.scene.surfaces().traits().alpha && fits_memory(plan, most))
        return 0;
    for (const auto& [rays, members] : by_rays) {
        const GatherEstimate estimate = estimate_gather(plan, tracer, rays, members, stop);
        likely += estimate.bytes;
        traced += estimate.rays;
    }
    check_memory(plan, likely);
    return traced;
}

} // namespace

TracedGather trace_gather(const BakePlan& plan, Tracer& tracer, std::span<const std::uint32_t> rays_of,
                          Transfer& transfer, const Progress& progress) {
    ByRays by_rays;
    std::size_t all = 0, done = 0;
    for (const std::uint32_t p : receivers_on_surfaces(plan.receivers())) {
        by_rays[rays_of[p]].push_back(p);
        all += rays_of[p];
    }
    TracedGather traced{empty_gather(plan), all + check_gather_memory(plan, tracer, by_rays, progress.stop)};
    const auto share = [&](std::size_t rays) { return static_cast<double>(rays) / static_cast<double>(all); };
    for (const auto& [rays, members] : by_rays) {
        const TraceOptions options = gather_options(plan, rays);
        const std::size_t here = members.size() * rays;
        trace_receivers(tracer, plan.receivers(), members, options, transfer,
                        progress.part(share(done), share(done + here)),
                        [&](std::uint32_t p, std::span<const Hit> hits) {
                            traced.gather.set_row(p, hits, options.rays);
                        });
        done += here;
    }
    return traced;
}

} // namespace prt
