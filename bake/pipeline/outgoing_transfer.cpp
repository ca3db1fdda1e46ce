// Adds bounces to measured light, and removes the back sides of surfaces.

#include "bake/pipeline/outgoing_transfer.h"

#include "bake/plan/transfer_terms.h"
#include "bake/surface_fit/fit_noise.h"
#include "prt/core/error.h"
#include "prt/core/sh_basis.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace prt {
namespace {

/// Converts exit transfer of both sides of surfaces to that of the scene's receivers, in place.
void leave_back_sides(const BakePlan& plan, Transfer& exit) {
    if (plan.scene.surfaces().traits().transmission)
        add_transmission(exit, plan.scene.surfaces(), *plan.transport);
    exit.vectors.resize(plan.transport->fronts * exit.dimension());
}

constexpr float kReflectsAll = 0.999f; ///< base colors above this count as 1

/// Returns names of nodes, at most kNamed, whose surfaces reflect all light of some color.
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

/// Throws `EndlessLampLight` if endless bounces did not converge. The light of a lamp grows without limit in
/// a closed room whose walls reflect all of it. Operators of bounces are not negative, so that a solution
/// with negative light is not a sum over bounces.
void check_converged(const BakePlan& plan, const Propagated& lit, int bounces) {
    if (bounces != kEndlessBounces)
        return;
    float least = 0, most = 0;
    for (const float v : lit.transfer.vectors) {
        least = std::min(least, v);
        most = std::max(most, v);
    }
    if (!lit.converged || least < -1e-2f * most)
        throw EndlessLampLight(fmt::format(
            "the light of lamps does not converge with endless bounces: a closed room reflects all "
            "of it (base color 1: {}); use darker base colors or limit the bounces (--bounces 8)",
            nodes_that_reflect_all(plan.scene.surfaces())));
}

/// Whether bounces process the color channels of lamps separately, one after the other.
bool separate_colors(const BakePlan& plan, const Transfer& light) {
    return plan.channels == 1 && light.layout.channels() == 3;
}

/// Joins the results of three channels into one result with three channels.
Propagated in_color(const Propagated& red, const Propagated& green, const Propagated& blue) {
    Propagated all{.transfer = in_color(red.transfer, green.transfer, blue.transfer)};
    const std::size_t columns = red.transfer.dimension();
    for (std::size_t rows = 0; rows < red.optional_work.size(); ++rows) {
        std::vector<float>& to = all.optional_work.emplace_back();
        for (std::size_t begin = 0; begin < red.optional_work[rows].size(); begin += columns)
            for (const Propagated* one : {&red, &green, &blue}) {
                const auto from = one->optional_work[rows].begin() + static_cast<std::ptrdiff_t>(begin);
                to.insert(to.end(), from, from + static_cast<std::ptrdiff_t>(columns));
            }
    }
    for (const Propagated* one : {&red, &green, &blue}) {
        all.bounces = std::max(all.bounces, one->bounces);
        all.remaining = std::max(all.remaining, one->remaining);
        all.converged = all.converged && one->converged;
    }
    return all;
}

/// Extracts one channel of light at samples.
SampledLight one_channel(const SampledLight& light, std::size_t channels, std::size_t channel) {
    const auto slice = [&](const std::vector<float>& all, std::size_t stride) {
        std::vector<float> term;
        term.reserve(all.size() / channels);
        for (std::size_t begin = channel * (stride / channels); begin < all.size(); begin += stride)
            term.insert(term.end(), all.begin() + static_cast<std::ptrdiff_t>(begin),
                        all.begin() + static_cast<std::ptrdiff_t>(begin + stride / channels));
        return term;
    };
    return {.stride = light.stride / channels,
            .tests = light.tests / channels,
            .sums = slice(light.sums, light.stride),
            .sharp = {},
            .values = slice(light.values, light.tests)};
}

/// Calls `work` with the operators for one channel of the light of lamps.
template <class Work>
auto in_channel(TransportOperators operators, int channel, const Work& work) {
    Transfer sources;
    if (operators.sources && operators.sources->layout.channels() > 1) {
        sources = one_channel(*operators.sources, channel);
        operators.sources = &sources;
    }
    return work(operators);
}

/// Propagates lamps at samples of the surface. The light has one channel, or the same number of channels as
/// the bounces.
SharpTransfer sharp_lamps(const BakePlan& plan, Transfer smooth, const SampledLight& sampled,
                          const GatherOperator* last, const TransportOperators& operators,
                          const Progress& progress) {
    const int channels = smooth.layout.channels();
    const TestValues tests = TestValues::of_lamps(plan.lamps.size(), channels,
                                                  smooth.dimension() / static_cast<std::size_t>(channels));
    const SurfaceFit& fit = *operators.fit;
    const auto by_noise = [&](const SampledLight& rest) {
        return lamp_solver(fit.samples, fit.equations, rest.values, tests.count(), plan.options.seed,
                           plan.options.threads);
    };
    return propagate_sharply(std::move(smooth),
                             {.direct = sampled,
                              .solver = *fit.lamps,
                              .for_rest = by_noise,
                              .of_direct = tests,
                              .of_rest = tests,
                              .last = last},
                             operators, plan.bounces, plan.options.threads, progress);
}

SharpTransfer sharp_lamps_in_color(const BakePlan& plan, const Transfer& smooth, const SampledLight& sampled,
                                   const GatherOperator* last, const TransportOperators& operators,
                                   const Progress& progress) {
    const auto color = [&](int c) {
        return in_channel(operators, c, [&](const TransportOperators& here) {
            return sharp_lamps(plan, one_channel(smooth, c),
                               one_channel(sampled, 3, static_cast<std::size_t>(c)), last, here, progress);
        });
    };
    const SharpTransfer red = color(0), green = color(1), blue = color(2);
    return {in_color(red.direct, green.direct, blue.direct), in_color(red.exit, green.exit, blue.exit)};
}

/// Adds `rows` to the operators, so that they also gather the last bounce at these receivers.
TransportOperators with_rows(TransportOperators operators,
                             std::initializer_list<const GatherOperator*> rows) {
    for (const GatherOperator* one : rows)
        if (one)
            operators.optional_work.push_back(one);
    return operators;
}

/// Root of the sum of squares over the surface of a lamp's light that is written.
double norm_of_lamp(const BakePlan& plan, const Transfer& light, const Transfer& unbounced,
                    std::size_t lamp) {
    const auto channels = static_cast<std::size_t>(light.layout.channels());
    const bool bounces_alone = plan.options.lamps.mode == LampMode::indirect;
    double sum = 0;
    for (std::uint32_t p = 0; p < light.receivers(); ++p)
        for (std::size_t c = 0; c < channels; ++c) {
            const std::size_t i = c * (light.dimension() / channels) + lamp;
            const auto value =
                static_cast<double>(light.vector(p)[i] - (bounces_alone ? unbounced.vector(p)[i] : 0.0f));
            sum += static_cast<double>(plan.receivers().areas[p]) * value * value;
        }
    return std::sqrt(sum);
}

/// Computes light of lamps at receivers after all bounces.
Propagated lamps_at_receivers(const BakePlan& plan, Transfer light, const std::optional<LampRows>& rows,
                              const TransportOperators& operators, const OptionalWork& optional_work,
                              const Progress& progress) {
    const Transfer unbounced = rows ? light : Transfer();
    const bool halves = rows && rows->half && optional_work.filter;
    Propagated lit =
        propagate_lamps_on_both_sides(plan, std::move(light),
                                      with_rows(operators, {optional_work.points, rows ? &rows->all : nullptr,
                                                            halves ? &*rows->half : nullptr}),
                                      plan.bounces, progress);
    if (rows) {
        const std::size_t first = optional_work.points ? 1 : 0;
        std::vector<double>& noise = optional_work.noise->lamps;
        noise = take_last_of_lamps(
            {lit.optional_work[first],
             halves ? std::span<const float>(lit.optional_work[first + 1]) : std::span<const float>()},
            *optional_work.left_out, optional_work.filter, plan.lamps.size(), unbounced, lit.transfer);
        for (std::size_t k = 0; k < noise.size(); ++k)
            if (const double norm = norm_of_lamp(plan, lit.transfer, unbounced, k); norm > 0)
                noise[k] /= norm;
        lit.optional_work.resize(first);
    }
    return lit;
}

/// Computes exit light after all bounces, and incident light without a bounce if it will be subtracted.
SharpTransfer lit_by_lamps(const BakePlan& plan, Measured& measured, const TransportOperators& operators,
                           const OptionalWork& optional_work, const Progress& progress) {
    Transfer& light = measured.lamps.light.transfer;
    const SampledLight& sampled = measured.lamps.sampled;
    const std::optional<LampRows>& rows = measured.direct.lamps;
    SharpTransfer lit;
    if (!operators.fit) {
        if (plan.options.lamps.mode == LampMode::indirect)
            lit.direct = light;
        lit.exit = lamps_at_receivers(plan, std::move(light), rows, operators, optional_work, progress);
    } else {
        const GatherOperator* last = rows ? &rows->all : nullptr;
        const TransportOperators with_points = with_rows(operators, {optional_work.points});
        lit = separate_colors(plan, light)
                  ? sharp_lamps_in_color(plan, light, sampled, last, with_points, progress)
                  : sharp_lamps(plan, std::move(light), sampled, last, with_points, progress);
        check_converged(plan, lit.exit, plan.bounces);
    }
    return lit;
}

/// Noise of a whole net over half of the difference between its two halves: 0.74 if the squared noise of n
/// rays falls as n^-1.5, because both halves then complement each other.
constexpr float kNoiseOfHalves = 0.75f;

/// Filters the sky's light `all` at receivers; `direct` is its part without a bounce. `gathered` has the
/// layout of `all` and contains light that half of the rays gather; empty: no bounces.
void filter_sky(const NoiseFilter& filter, const HalfOfRays& half, std::span<const float> gathered,
                Transfer& direct, Transfer& all, BakeNoise& left) {
    const std::size_t stride = all.dimension(), columns = direct.dimension();
    RepresentativeColumns representative = columns_of_sky(columns);
    if (stride > columns) // the green channel
        for (std::size_t& c : representative.columns)
            c += columns;
    const auto of_direct = [&](std::uint32_t p, std::size_t c) {
        const std::size_t i = c % columns;
        return kNoiseOfHalves * half.scale[p] * (half.direct.vector(p)[i] - direct.vector(p)[i]);
    };
    const auto of_rest = [&](std::uint32_t p, std::size_t c) {
        const float bounced = gathered.empty() ? 0.0f : gathered[p * stride + c],
                    rest = all.vector(p)[c] - direct.vector(p)[c % columns];
        return kNoiseOfHalves * half.scale[p] * (bounced - rest);
    };
    const auto of_all = [&](std::uint32_t p, std::size_t c) { return of_direct(p, c) + of_rest(p, c); };
    const auto value = [&](std::uint32_t p, std::size_t c) { return all.vector(p)[c]; };
    const FitSolver solver = filter.fit(value, representative, of_all);
    if (const double norm = filter.norm(solver, representative, value); norm > 0)
        left = {.filtered = true,
                .sky = filter.norm(solver, representative, of_all) / norm,
                .direct = filter.norm(solver, representative, of_direct) / norm,
                .indirect = filter.norm(solver, representative, of_rest) / norm};
    // Channel by channel: columns are solved in groups, and columns that are equal in two channels remain
    // equal.
    for (std::size_t first = 0; first < stride; first += columns)
        filter.apply(
            solver, columns, [&](std::uint32_t p, std::size_t c) { return all.vector(p)[first + c]; },
            [&](std::uint32_t p, std::size_t c, float filtered) { all.vector(p)[first + c] = filtered; });
    filter.apply(solver, direct);
}

} // namespace

Propagated propagate_all(const BakePlan& plan, Measured& measured, const TransportOperators& operators,
                         const OptionalWork& optional_work, const Progress& progress) {
    const bool bounced = operators.gather || !operators.diffusion.empty();
    const int threads = plan.options.threads;
    const auto wide = [&](Transfer transfer) {
        return plan.channels == 3 && transfer.layout.channels() == 1 ? in_color(transfer)
                                                                     : std::move(transfer);
    };
    Transfer direct = std::move(measured.direct.transfer);
    const HalfOfRays* half = measured.direct.half && optional_work.filter ? &*measured.direct.half : nullptr;
    const GatherOperator* rows_of_half = half && half->gather ? &*half->gather : nullptr;
    const TransportOperators all_rows = with_rows(operators, {optional_work.points, rows_of_half});
    Propagated exit;
    if (operators.fit) {
        const TestValues of_direct = TestValues::of_sky(plan.options.order, 1),
                         of_rest = TestValues::of_sky(plan.options.order, plan.channels);
        SharpTransfer sharp = propagate_sharply(wide(std::move(direct)),
                                                {.direct = measured.sky,
                                                 .solver = operators.fit->sky,
                                                 .for_rest = {},
                                                 .of_direct = of_direct,
                                                 .of_rest = of_rest},
                                                all_rows, plan.bounces, threads, progress);
        direct = std::move(sharp.direct);
        exit = std::move(sharp.exit);
    }
    Transfer unbounced = exit_without_bounces(plan, direct, operators.refill);
    if (!operators.fit && bounced)
        exit = propagate(wide(std::move(direct)), all_rows, plan.bounces, threads, progress);
    if (half) {
        if (!bounced)
            exit.transfer = unbounced;
        filter_sky(*optional_work.filter, *half,
                   rows_of_half ? std::span<const float>(exit.optional_work.back())
                                : std::span<const float>(),
                   unbounced, exit.transfer, *optional_work.noise);
        if (rows_of_half)
            exit.optional_work.pop_back();
    }
    if (plan.direct_channels() == 3)
        unbounced = in_color(unbounced);
    leave_back_sides(plan, unbounced);
    if (!bounced) {
        exit.transfer = narrowed(std::move(unbounced));
        return exit;
    }
    leave_back_sides(plan, exit.transfer);
    exit.transfer = in_terms(narrowed(std::move(unbounced)), exit.transfer);
    return exit;
}

Propagated propagate_lamps_on_both_sides(const BakePlan& plan, Transfer light,
                                         const TransportOperators& operators, int bounces,
                                         const Progress& progress) {
    const int threads = plan.options.threads;
    Propagated all;
    if (separate_colors(plan, light)) {
        const auto color = [&](int c) {
            return in_channel(operators, c, [&](const TransportOperators& here) {
                return propagate(one_channel(light, c), here, bounces, threads, progress);
            });
        };
        const Propagated red = color(0), green = color(1), blue = color(2);
        all = in_color(red, green, blue);
    } else {
        all = propagate(std::move(light), operators, bounces, threads, progress);
    }
    check_converged(plan, all, bounces);
    return all;
}

Propagated propagate_lamps(const BakePlan& plan, Measured& measured, const TransportOperators& operators,
                           const OptionalWork& optional_work, const Progress& progress) {
    SharpTransfer lit = lit_by_lamps(plan, measured, operators, optional_work, progress);
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
