// Traces direct light with the same number of rays everywhere, or with an adaptive number per receiver.

#include "bake/pipeline/direct.h"

#include "bake/pipeline/adaptive.h"
#include "bake/pipeline/equal_rays.h"
#include "bake/pipeline/sampling_error.h"
#include "bake/pipeline/trace_gather.h"
#include "bake/trace/trace_receivers.h"

#include <cmath>
#include <numeric>

namespace prt {
namespace {

/// Traces direct light with an adaptive number of rays. Returns that number, [receivers].
std::vector<std::uint32_t> trace_adaptively(const BakePlan& plan, Tracer& tracer, const TraceOptions& options,
                                            std::span<const float> left, DirectLight& direct,
                                            const Progress& progress) {
    AdaptiveResult adaptive =
        adaptive_transfer(tracer, plan.transport->measured(),
                          MeshNeighbours(plan.scene.surfaces(), plan.receivers(), plan.transport->fronts),
                          left, options, *plan.options.target_error, progress);
    direct.transfer = std::move(adaptive.transfer);
    if (direct.half)
        direct.half->direct = std::move(adaptive.half);
    direct.rays = std::accumulate(adaptive.rays.begin(), adaptive.rays.end(), adaptive.rays_checked);
    direct.sampling_error = adaptive.error;
    if (!adaptive.reached)
        direct.notices.push_back(missed_target());
    return std::move(adaptive.rays);
}

/// Draws depth maps from the smallest number of directions that reaches the target error. All receivers share
/// the directions, so that their noise is alike: `left` has no effect. Returns the number, [receivers].
std::vector<std::uint32_t> draw_to_target(const BakePlan& plan, Tracer& tracer, TraceOptions options,
                                          std::span<const std::uint32_t> indices, DirectLight& direct,
                                          const Progress& progress) {
    const Receivers& receivers = plan.transport->measured();
    direct.transfer = zero_transfer(options.order, 1, receivers.size());
    const EqualRays equal = equal_rays(*plan.options.target_error, [&](int rays) {
        options.rays = rays;
        trace_receivers(tracer, receivers, indices, options, direct.transfer, {{}, progress.stop});
        const SamplingError sampling =
            sampling_error(tracer, receivers, options, direct.transfer, progress.stop);
        direct.rays += indices.size() * static_cast<std::size_t>(rays) + sampling.rays;
        return sampling.error;
    });
    direct.sampling_error = equal.error;
    if (!equal.reached)
        direct.notices.push_back(missed_target());
    return std::vector<std::uint32_t>(receivers.size(), static_cast<std::uint32_t>(equal.rays));
}

void add_gather(const BakePlan& plan, Tracer& tracer, const LampConnections* lamps,
                std::span<const std::uint32_t> rays_of, DirectLight& direct, const Progress& progress) {
    TracedGather traced = trace_gather(plan, tracer, lamps, rays_of, direct.transfer,
                                       direct.half ? &*direct.half : nullptr, progress);
    direct.rays += traced.rays;
    if (traced.gather.entries() == 0) {
        direct.notices.push_back(
            "bounces are skipped: no ray from a receiver hits a surface that reflects light diffusely");
        if (direct.half)
            direct.half->gather.reset();
        return;
    }
    direct.gather.emplace(std::move(traced.gather));
    if (traced.lamps)
        direct.lamps.emplace(std::move(*traced.lamps));
}

} // namespace

HalfOfRays::HalfOfRays(const BakePlan& plan, std::span<const std::uint32_t> rays_of)
    : direct(zero_transfer(plan.options.order, 1, plan.receivers().size())) {
    for (const std::uint32_t rays : rays_of) {
        const auto half = static_cast<float>(first_half(static_cast<int>(rays)));
        scale.push_back(std::sqrt(half / (static_cast<float>(rays) - half)));
    }
}

double noise_left(const BakePlan& plan, std::span<const float> left) {
    double all = 0, sum = 0;
    for (std::size_t p = 0; p < plan.areas().size(); ++p) {
        const auto area = static_cast<double>(plan.areas()[p]);
        all += area;
        sum += area * static_cast<double>(left[p]);
    }
    return all > 0 ? std::sqrt(sum / all) : 1;
}

DirectLight trace_direct(const BakePlan& plan, Tracer& tracer, const LampConnections* lamps,
                         std::span<const float> left, const Progress& progress) {
    const Receivers& receivers = plan.transport->measured();
    const std::vector<std::uint32_t> indices = receivers_on_surfaces(receivers);
    const TraceOptions options{
        .order = plan.options.order, .rays = plan.options.rays, .seed = plan.options.seed};
    const bool adaptive = plan.options.target_error.has_value();
    const bool traces = tracer.method() == BakeMethod::trace,
               halves = plan.options.repairs.denoise && traces && first_half(options.rays) > 0;
    DirectLight direct;
    std::vector<std::uint32_t> rays_of(receivers.size(), static_cast<std::uint32_t>(options.rays));
    if (halves)
        direct.half.emplace(plan, rays_of);
    if (adaptive) {
        const Progress part = plan.bounces != 0 ? progress.range(0, 0.5) : progress;
        rays_of = traces ? trace_adaptively(plan, tracer, options, left, direct, part)
                         : draw_to_target(plan, tracer, options, indices, direct, part);
    } else {
        direct.transfer = zero_transfer(options.order, 1, receivers.size());
    }
    if (plan.bounces != 0) {
        add_gather(plan, tracer, lamps, rays_of, direct, progress.range(adaptive ? 0.5 : 0, 1));
    } else if (!adaptive) {
        if (halves)
            trace_in_halves(tracer, receivers, indices, options, {direct.transfer, direct.half->direct},
                            progress);
        else
            trace_receivers(tracer, receivers, indices, options, direct.transfer, progress);
        direct.rays = indices.size() * static_cast<std::size_t>(options.rays);
    }
    if (!adaptive && !halves && !plan.measures_errors && traces) {
        const SamplingError sampling =
            sampling_error(tracer, receivers, options, direct.transfer, progress.stop);
        direct.sampling_error = sampling.error * noise_left(plan, left);
        direct.rays += sampling.rays;
    }
    direct.mean_rays = indices.empty()
                           ? 0
                           : static_cast<int>(std::accumulate(rays_of.begin(), rays_of.end(), 0.0) /
                                              static_cast<double>(rays_of.size()));
    direct.mean_visibility = mean_visibility(direct.transfer, plan.areas());
    return direct;
}

} // namespace prt
