// Fits light at samples as ordinary bakes do. The samples of surfaces that are drawn once gather the light
// that all receivers of the flat scene send into the last bounce.

#include "bake/products/instances/own_fit.h"

#include "bake/pipeline/light_transport.h"
#include "bake/plan/transfer_terms.h"

#include <algorithm>

namespace prt {
namespace {

/// Returns the plan without rays from receivers of instances, and without media.
BakePlan plan_of_own(const BakePlan& plan, const InstanceReceivers& receivers) {
    TransportReceivers own = *plan.transport;
    for (std::size_t r = 0; r < own.receivers.size(); ++r)
        if (receivers.own_of[r] == kNoReceiver) {
            own.receivers.normals[r] = glm::vec3(0);
            own.receivers.areas[r] = 0;
        }
    return {.scene = plan.scene,
            .options = plan.options,
            .bounces = plan.bounces,
            .channels = plan.channels,
            .transport = std::make_unique<const TransportReceivers>(std::move(own)),
            .diffusion = {},
            .lamps = {},
            .notices = {}};
}

Transfer wide(const BakePlan& plan, Transfer light) {
    light.layout.terms.front().kind = TermKind::direct;
    return plan.channels == 3 && light.layout.channels() == 1 ? in_color(light) : light;
}

SharpTransfer sharp_transfer(const BakePlan& plan, const Measured& measured, Transfer light, int bounces,
                             const Progress& progress) {
    const TestValues of_direct = TestValues::of_sky(plan.options.order, 1),
                     of_rest = TestValues::of_sky(plan.options.order, plan.channels);
    const TransportOperators operators{.refill = measured.sealed.refill,
                                       .diffusion = plan.diffusion,
                                       .gather = measured.direct.gather ? &*measured.direct.gather : nullptr,
                                       .fit = &*measured.fit};
    return propagate_sharply(std::move(light),
                             {.direct = measured.sky,
                              .solver = measured.fit->sky,
                              .for_rest = {},
                              .of_direct = of_direct,
                              .of_rest = of_rest},
                             operators, bounces, plan.options.threads, progress);
}

} // namespace

FittedTransfer fitted_transfer(const BakePlan& plan, const Measured& measured, const Progress& progress) {
    SharpTransfer sharp =
        sharp_transfer(plan, measured, wide(plan, measured.direct.transfer), plan.bounces, progress);
    return {exit_without_bounces(plan, std::move(sharp.direct), measured.sealed.refill),
            std::move(sharp.exit.transfer)};
}

OwnFit::OwnFit(const BakePlan& plan, Tracer& tracer, const InstanceReceivers& receivers,
               const Progress& progress)
    : plan_(plan_of_own(plan, receivers)),
      measured_(measure(plan_, tracer, LastOfLamps::as_others, asked_, progress)) {}

std::size_t OwnFit::rays() const {
    return asked_.rays + measured_.direct.rays + measured_.sealed.rays;
}

FittedTransfer OwnFit::light(std::vector<float> exit, std::span<const DiffusionOperator* const> media,
                             const Progress& progress) const {
    const bool bounced = !exit.empty();
    Transfer last = wide(plan_, measured_.direct.transfer);
    if (bounced)
        last.vectors = std::move(exit);
    SharpTransfer sharp = sharp_transfer(plan_, measured_, std::move(last), bounced ? 1 : 0, progress);
    FittedTransfer light{exit_without_bounces(plan_, std::move(sharp.direct), measured_.sealed.refill),
                         std::move(sharp.exit.transfer)};
    for (const DiffusionOperator* const body : media) {
        body->apply(plan_.channels, plan_.options.order, light.all.vectors, plan_.options.threads);
        for (const std::uint32_t r : body->members()) // all of its light passes the medium
            std::ranges::fill(light.direct.vector(r), 0.0f);
    }
    return light;
}

} // namespace prt
