// Adds bounces to measured light, and takes the back sides of surfaces off.

#include "exit_light.h"

#include "parts.h"
#include "prt/sh_basis.h"
#include "prt/support/error.h"

#include <algorithm>
#include <utility>

namespace prt {
namespace {

/// Exit transfer of the scene's receivers from that of both sides of its surfaces.
void leave_back_sides(const BakePlan& plan, Transfer& exit) {
    if (plan.scene.surfaces().traits().transmission)
        add_transmission(exit, plan.scene.surfaces(), *plan.transport);
    exit.vectors.resize(plan.transport->fronts * exit.dimension());
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

} // namespace

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

Propagated propagate_lamps_on_both_sides(const BakePlan& plan, Transfer light,
                                         const TransportOperators& operators, int bounces,
                                         const Progress& progress) {
    const int threads = plan.options.threads;
    Propagated all;
    if (plan.channels == 1 && light.layout.channels() == 3) { // colors one after the other
        Transfer colors[3];
        for (int c = 0; c < 3; ++c) {
            Propagated one = propagate(one_channel(light, c), operators, bounces, threads, progress);
            colors[c] = std::move(one.transfer);
            all.bounces = std::max(all.bounces, one.bounces);
            all.remaining = std::max(all.remaining, one.remaining);
            all.converged = all.converged && one.converged;
        }
        all.transfer = in_color(colors[0], colors[1], colors[2]);
    } else {
        all = propagate(std::move(light), operators, bounces, threads, progress);
    }
    check_has_an_end(all);
    return all;
}

Propagated propagate_lamps(const BakePlan& plan, Transfer light, const TransportOperators& operators,
                           const Progress& progress) {
    Transfer unbounced;
    if (plan.options.lamps.mode == LampMode::indirect) {
        unbounced = exit_without_bounces(plan, light, operators.refill);
        leave_back_sides(plan, unbounced);
    }
    Propagated exit =
        propagate_lamps_on_both_sides(plan, std::move(light), operators, plan.bounces, progress);
    leave_back_sides(plan, exit.transfer);
    const std::size_t stride = static_cast<std::size_t>(coefficient_count(unbounced.layout.order));
    for (std::size_t i = 0; i < unbounced.vectors.size(); ++i)
        if (i % stride < plan.lamps.size())
            exit.transfer.vectors[i] -= unbounced.vectors[i];
    return exit;
}

} // namespace prt
