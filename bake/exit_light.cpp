// Adds bounces to measured light, and takes the back sides of surfaces off.

#include "exit_light.h"

#include "lamps/lamp_bounces.h"
#include "parts.h"
#include "prt/sh_basis.h"
#include "prt/support/error.h"
#include "surface/fit_noise.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace prt {
namespace {

/// Exit transfer of the scene's receivers from that of both sides of its surfaces.
void leave_back_sides(const BakePlan& plan, Transfer& exit) {
    if (plan.scene.surfaces().traits().transmission)
        add_transmission(exit, plan.scene.surfaces(), *plan.transport);
    exit.vectors.resize(plan.transport->fronts * exit.dimension());
}

constexpr float kReflectsAll = 0.999f; ///< base colors above are as good as 1

/// Names of the nodes whose surfaces reflect all light of some color, some of them.
std::string nodes_that_reflect_all(const Surfaces& surfaces) {
    constexpr std::size_t kNamed = 4;
    std::vector<std::string> names;
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        const Scattering s = surfaces.scattering({t, {1.0f / 3, 1.0f / 3}, 0});
        const glm::vec3 all = s.reflected + s.transmitted;
        const std::string& name = surfaces.scene().primitives[surfaces.primitive(t)].node_name;
        if (std::max({all.x, all.y, all.z}) >= kReflectsAll && std::ranges::count(names, name) == 0)
            names.push_back(name);
    }
    if (names.size() > kNamed) {
        names.resize(kNamed);
        names.emplace_back("...");
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

/// Light of a lamp in a closed room whose walls reflect all of it grows without end. Operators of bounces are
/// not negative, so that a solution with negative light is no sum over bounces.
void check_converged(const BakePlan& plan, const Propagated& lit, int bounces) {
    if (bounces != kEndlessBounces)
        return;
    float least = 0, most = 0;
    for (const float v : lit.transfer.vectors) {
        least = std::min(least, v);
        most = std::max(most, v);
    }
    if (!lit.converged || least < -1e-2f * most)
        throw EndlessLampLight(
            fmt::format("light of lamps grows without end in endless bounces: a closed room reflects all of "
                        "it (base color 1: {}); lower these base colors, or limit the bounces (--bounces 8)",
                        nodes_that_reflect_all(plan.scene.surfaces())));
}

/// Whether bounces treat each color of lamps alone, one after the other.
bool colors_apart(const BakePlan& plan, const Transfer& light) {
    return plan.channels == 1 && light.layout.channels() == 3;
}

/// One result of those of three colors, [rows][columns] each at the rows of a check.
Propagated in_color(const Propagated& red, const Propagated& green, const Propagated& blue) {
    Propagated all{.transfer = in_color(red.transfer, green.transfer, blue.transfer)};
    const std::size_t columns = red.transfer.dimension();
    for (std::size_t begin = 0; begin < red.at_check.size(); begin += columns)
        for (const Propagated* one : {&red, &green, &blue}) {
            const auto from = one->at_check.begin() + static_cast<std::ptrdiff_t>(begin);
            all.at_check.insert(all.at_check.end(), from, from + static_cast<std::ptrdiff_t>(columns));
        }
    for (const Propagated* one : {&red, &green, &blue}) {
        all.bounces = std::max(all.bounces, one->bounces);
        all.remaining = std::max(all.remaining, one->remaining);
        all.converged = all.converged && one->converged;
    }
    return all;
}

/// One channel of light at samples.
SampledLight one_channel(const SampledLight& light, std::size_t channels, std::size_t channel) {
    const auto slice = [&](const std::vector<float>& all, std::size_t stride) {
        std::vector<float> part;
        part.reserve(all.size() / channels);
        for (std::size_t begin = channel * (stride / channels); begin < all.size(); begin += stride)
            part.insert(part.end(), all.begin() + static_cast<std::ptrdiff_t>(begin),
                        all.begin() + static_cast<std::ptrdiff_t>(begin + stride / channels));
        return part;
    };
    return {.stride = light.stride / channels,
            .tests = light.tests / channels,
            .sums = slice(light.sums, light.stride),
            .sharp = {},
            .values = slice(light.values, light.tests)};
}

/// Sharp light of lamps. It has one channel, or as many channels as the bounces.
SharpTransfer sharp_lamps(const BakePlan& plan, Transfer smooth, const SampledLight& sampled,
                          const TransportOperators& operators, const Progress& progress) {
    const int channels = smooth.layout.channels();
    const TestValues tests = TestValues::of_lamps(plan.lamps.size(), channels,
                                                  smooth.dimension() / static_cast<std::size_t>(channels));
    std::optional<FitSolver> solver;
    const auto by_noise = [&](const SampledLight& direct, const SampledLight* rest) -> const FitSolver& {
        std::vector<float> values = direct.values;
        for (std::size_t i = 0; rest && i < values.size(); ++i)
            values[i] += rest->values[i];
        const SurfaceFit& fit = *operators.fit;
        return solver.emplace(lamp_solver(fit.samples, fit.equations, values, tests.count(),
                                          plan.options.seed, plan.options.threads));
    };
    return propagate_sharply(std::move(smooth),
                             {.direct = sampled,
                              .solver = by_noise,
                              .of_direct = tests,
                              .of_rest = tests,
                              .last = operators.last_of_lamps},
                             operators, plan.bounces, plan.options.threads, progress);
}

SharpTransfer sharp_lamps_in_color(const BakePlan& plan, const Transfer& smooth, const SampledLight& sampled,
                                   const TransportOperators& operators, const Progress& progress) {
    const auto color = [&](int c) {
        return sharp_lamps(plan, one_channel(smooth, c), one_channel(sampled, 3, static_cast<std::size_t>(c)),
                           operators, progress);
    };
    const SharpTransfer red = color(0), green = color(1), blue = color(2);
    return {in_color(red.direct, green.direct, blue.direct), in_color(red.exit, green.exit, blue.exit)};
}

/// Exit light after all bounces, and incident light without a bounce where it will be subtracted.
SharpTransfer lit_by_lamps(const BakePlan& plan, MeasuredLamps lamps, const TransportOperators& operators,
                           const Progress& progress) {
    Transfer& light = lamps.light.transfer;
    SharpTransfer lit;
    if (!operators.fit) {
        if (plan.options.lamps.mode == LampMode::indirect)
            lit.direct = light;
        const Transfer unbounced = operators.lamps ? light : Transfer();
        lit.exit = propagate_lamps_on_both_sides(plan, std::move(light), operators, plan.bounces, progress);
        if (operators.lamps)
            operators.lamps->apply(lit.exit.transfer, unbounced, lit.exit.at_check);
    } else {
        lit = colors_apart(plan, light)
                  ? sharp_lamps_in_color(plan, light, lamps.sampled, operators, progress)
                  : sharp_lamps(plan, std::move(light), lamps.sampled, operators, progress);
        check_converged(plan, lit.exit, plan.bounces);
    }
    return lit;
}

} // namespace

Propagated propagate_all(const BakePlan& plan, Transfer direct, const SampledLight& sampled,
                         const TransportOperators& operators, const Progress& progress) {
    const bool bounced = operators.gather || !operators.diffusion.empty();
    const auto wide = [&](Transfer transfer) {
        return plan.channels == 3 && transfer.layout.channels() == 1 ? in_color(transfer)
                                                                     : std::move(transfer);
    };
    Propagated exit;
    if (operators.fit) {
        const TestValues of_direct = TestValues::of_sky(plan.options.order, 1),
                         of_rest = TestValues::of_sky(plan.options.order, plan.channels);
        SharpTransfer sharp =
            propagate_sharply(wide(std::move(direct)),
                              {.direct = sampled,
                               .solver = [&](const SampledLight&, const SampledLight*) -> const FitSolver& {
                                   return operators.fit->sky;
                               },
                               .of_direct = of_direct,
                               .of_rest = of_rest},
                              operators, plan.bounces, plan.options.threads, progress);
        direct = std::move(sharp.direct);
        exit = std::move(sharp.exit);
    }
    Transfer unbounced = exit_without_bounces(plan, direct, operators.refill);
    if (!operators.fit && bounced)
        exit = propagate(wide(std::move(direct)), operators, plan.bounces, plan.options.threads, progress);
    if (plan.direct_channels() == 3)
        unbounced = in_color(unbounced);
    leave_back_sides(plan, unbounced);
    if (!bounced) {
        exit.transfer = narrowed(std::move(unbounced));
        return exit;
    }
    leave_back_sides(plan, exit.transfer);
    exit.transfer = in_parts(narrowed(std::move(unbounced)), exit.transfer);
    return exit;
}

Propagated propagate_lamps_on_both_sides(const BakePlan& plan, Transfer light,
                                         const TransportOperators& operators, int bounces,
                                         const Progress& progress) {
    const int threads = plan.options.threads;
    Propagated all;
    if (colors_apart(plan, light)) {
        const auto color = [&](int c) {
            return propagate(one_channel(light, c), operators, bounces, threads, progress);
        };
        const Propagated red = color(0), green = color(1), blue = color(2);
        all = in_color(red, green, blue);
    } else {
        all = propagate(std::move(light), operators, bounces, threads, progress);
    }
    check_converged(plan, all, bounces);
    return all;
}

Propagated propagate_lamps(const BakePlan& plan, MeasuredLamps lamps, const TransportOperators& operators,
                           const Progress& progress) {
    SharpTransfer lit = lit_by_lamps(plan, std::move(lamps), operators, progress);
    leave_back_sides(plan, lit.exit.transfer);
    if (plan.options.lamps.mode == LampMode::indirect) {
        Transfer unbounced = exit_without_bounces(plan, std::move(lit.direct), operators.refill);
        leave_back_sides(plan, unbounced);
        for (std::size_t i = 0; i < unbounced.vectors.size(); ++i)
            lit.exit.transfer.vectors[i] -= unbounced.vectors[i];
    }
    return std::move(lit.exit);
}

} // namespace prt
