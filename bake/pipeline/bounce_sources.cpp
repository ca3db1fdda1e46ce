// Computes all bounces between the vertices of a scene except the last one.

#include "bake/pipeline/bounce_sources.h"

#include "bake/pipeline/direct_transfer.h"
#include "bake/pipeline/outgoing_transfer.h"
#include "bake/plan/transfer_terms.h"
#include "bake/trace/lamp_light.h"

#include <memory>

namespace prt {

BounceSources bounce_sources(const BakePlan& plan, Tracer& tracer, const Progress& progress) {
    BounceSources sources;
    const LampTask no_task{.scene = plan.scene,
                           .receivers = Receivers(),
                           .lamps = plan.lamps,
                           .options = plan.options.lamps,
                           .channels = plan.lamp_channels()};
    sources.lamps = no_lamp_light(no_task).transfer;
    if (plan.bounces == 0)
        return sources;
    BakeStatistics asked;
    Measured measured = measure(plan, tracer, LastOfLamps::as_others, asked, progress.range(0, 0.9));
    sources.rays = measured.direct.rays + measured.sealed.rays + measured.lamps.light.rays + asked.rays;
    if (!plan.lamps.empty())
        sources.connections.emplace(plan, measured.lamps.light.transfer);
    const std::unique_ptr<GatherProduct> product =
        measured.direct.gather ? tracer.gather_product(*measured.direct.gather) : nullptr;
    const TransportOperators operators{.refill = measured.sealed.refill,
                                       .diffusion = plan.diffusion,
                                       .gather = measured.direct.gather ? &*measured.direct.gather : nullptr,
                                       .product = product.get(),
                                       .fit = measured.fit ? &*measured.fit : nullptr};
    const int before = plan.bounces == kEndlessBounces ? kEndlessBounces : plan.bounces - 1;
    Transfer sky = plan.channels == 3 ? in_color(measured.direct.transfer) : measured.direct.transfer;
    Propagated lit =
        propagate(std::move(sky), operators, before, plan.options.threads, progress.range(0.9, 1));
    sources.bounces = lit.bounces + 1;
    sources.sky = std::move(lit.transfer);
    if (!plan.lamps.empty())
        sources.lamps = propagate_lamps_on_both_sides(plan, std::move(measured.lamps.light.transfer),
                                                      operators, before, {})
                            .transfer;
    return sources;
}

} // namespace prt
