// Sums bounces, one after another or all at once with a Krylov solver (docs/math.md, section 7).

#include "bake/pipeline/light_transport.h"

#include "bake/transport/krylov.h"
#include "prt/bake/bake.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace prt {
namespace {

/// Maximum norm of a receiver's vector in one channel.
double largest_norm(std::span<const float> vectors, std::size_t coefficients) {
    double largest = 0;
    for (std::size_t begin = 0; begin < vectors.size(); begin += coefficients) {
        float sum = 0;
        for (std::size_t k = 0; k < coefficients; ++k)
            sum += vectors[begin + k] * vectors[begin + k];
        largest = std::max(largest, static_cast<double>(sum));
    }
    return std::sqrt(largest);
}

void exit_from_incident(const TransportOperators& operators, int order, int channels,
                        std::span<float> vectors, int threads) {
    const int coefficients = coefficient_count(order);
    operators.refill.apply(vectors, static_cast<std::size_t>(channels * coefficients));
    for (const DiffusionOperator& diffusion : operators.diffusion)
        diffusion.apply(channels, order, vectors, threads);
}

/// Calls `work` with blocks of rows [rows][stride].
template <class Value, class Work>
void in_blocks(std::size_t rows, std::size_t stride, Work&& work) {
    constexpr std::size_t kRowsAtOnce = 1 << 14;
    std::vector<Value> some(std::min(kRowsAtOnce, rows) * stride);
    for (std::size_t first = 0; first < rows; first += kRowsAtOnce)
        work(first, std::span(some).first(std::min(kRowsAtOnce, rows - first) * stride));
}

/// Computes incident transfer of receivers from exit transfer; `gather(first, to)` writes the values of rows.
template <class Value, class Gather>
void incident_from_rows(const TransportOperators& operators, std::size_t stride, std::span<Value> incident,
                        Gather&& gather) {
    if (!operators.fit) {
        gather(0, incident);
        return;
    }
    const FitEquations& equations = operators.fit->equations;
    std::vector<Value> x(equations.unknowns * stride);
    in_blocks<Value>(operators.gather->rows(), stride, [&](std::size_t first, std::span<Value> block) {
        gather(first, block);
        add_samples(equations, first, std::span<const Value>(block), stride, std::span(x));
    });
    operators.fit->smooth(std::span(x), stride);
    spread_unknowns(equations, std::span<const Value>(x), stride, incident);
}

/// Computes incident transfer on the device, if it has the samples and enough memory for the sums. Returns
/// whether it did.
bool incident_from_device(const TransportOperators& operators, std::size_t stride,
                          std::span<float> incident) {
    if (!operators.product || !operators.fit)
        return false;
    const FitEquations& equations = operators.fit->equations;
    std::vector<float> x(equations.unknowns * stride);
    if (!operators.product->apply_to_sums({equations.rows.size(),
                                           [&](std::size_t s) { return sum_row(equations.rows[s]); },
                                           operators.fit->weights},
                                          x))
        return false;
    operators.fit->smooth(std::span(x), stride);
    spread_unknowns(equations, std::span<const float>(x), stride, incident);
    return true;
}

/// Prepares exit transfer for `gather_rows`.
void load_exit(const TransportOperators& operators, int order, std::span<float> exit, int threads) {
    if (operators.product)
        operators.product->load(order, exit);
    else
        operators.gather->reflect(order, exit, threads);
}

struct GatheredRows {
    std::size_t first;
    std::span<float> to; ///< [rows][stride]
};

/// Gathers loaded exit transfer into rows.
void gather_rows(const TransportOperators& operators, int order, std::span<const float> exit,
                 const GatheredRows& rows, int threads) {
    if (operators.product)
        operators.product->apply(rows.first, rows.to);
    else
        operators.gather->apply(order, exit, rows.first, rows.to, threads);
}

/// Operator of one bounce, from exit transfer to exit transfer.
ColumnOperator bounce_operator(const TransportOperators& operators, int order, int channels, int threads) {
    const auto stride = static_cast<std::size_t>(channels * coefficient_count(order));
    const auto apply = [&operators, order, channels, stride, threads](std::span<float> from,
                                                                      std::span<float> to) {
        load_exit(operators, order, from, threads);
        if (!incident_from_device(operators, stride, to))
            incident_from_rows(operators, stride, to, [&](std::size_t first, std::span<float> rows) {
                gather_rows(operators, order, from, {first, rows}, threads);
            });
        exit_from_incident(operators, order, channels, to, threads);
    };
    const auto residual = [&operators, order, stride, threads](std::span<const float> b,
                                                               std::span<const float> x, std::span<float> r) {
        std::vector<double> incident(x.size());
        incident_from_rows(operators, stride, std::span(incident),
                           [&](std::size_t first, std::span<double> rows) {
                               operators.gather->apply_in_double(order, x, first, rows, threads);
                           });
        operators.refill.apply(std::span<double>(incident), stride);
        for (std::size_t i = 0; i < r.size(); ++i)
            r[i] = static_cast<float>(static_cast<double>(b[i]) - static_cast<double>(x[i]) + incident[i]);
    };
    return {apply, residual};
}

/// Gathers one more bounce of `exit` transfer at other rows.
std::vector<std::vector<float>> gather_beside(const TransportOperators& operators, const Transfer& exit,
                                              int threads) {
    const int order = exit.layout.order;
    std::vector<std::vector<float>> gathered;
    std::vector<float> reflected;
    for (const GatherOperator* rows : operators.optional_work) {
        if (reflected.empty()) {
            reflected = exit.vectors;
            rows->reflect(order, reflected, threads);
        }
        gathered.emplace_back(rows->rows() * exit.dimension());
        rows->apply(order, reflected, 0, gathered.back(), threads);
    }
    return gathered;
}

/// Adds the last bounce, from surfaces that are not receivers.
Propagated gather_once(Transfer light, TransportOperators operators, int threads) {
    operators.optional_work.push_back(operators.gather);
    std::vector<std::vector<float>> gathered = gather_beside(operators, *operators.sources, threads);
    for (std::size_t i = 0; i < light.vectors.size(); ++i)
        light.vectors[i] += gathered.back()[i];
    gathered.pop_back();
    exit_from_incident(operators, light.layout.order, light.layout.channels(), light.vectors, threads);
    return {.transfer = std::move(light), .optional_work = std::move(gathered)};
}

/// Remaining energy after a bounce, as a geometric series, relative to the sum of all bounces.
double remaining_after(const BounceEnergy& energy, double total) {
    const double ratio = energy.before_last > 0 ? energy.last / energy.before_last : 0;
    if (energy.last == 0 || total == 0)
        return 0;
    return ratio < 1 ? energy.last * ratio / (1 - ratio) / total : 1;
}

/// Computes `bounces` bounces on the device, if light does not change between them.
std::optional<Propagated> bounce_on_device(Transfer& transfer, const TransportOperators& operators,
                                           int bounces, int threads, const Progress& progress) {
    if (!operators.product || operators.fit || !operators.diffusion.empty() || !operators.refill.empty())
        return std::nullopt;
    std::vector<std::vector<float>> optional_work;
    if (!operators.optional_work.empty()) {
        Transfer before = transfer;
        if (bounces > 1 && !operators.product->bounce(before, bounces - 1, progress))
            return std::nullopt;
        optional_work = gather_beside(operators, before, threads);
    }
    const std::optional<BounceEnergy> energy = operators.product->bounce(transfer, bounces, progress);
    if (!energy)
        return std::nullopt;
    const auto coefficients = static_cast<std::size_t>(coefficient_count(transfer.layout.order));
    const double total = largest_norm(transfer.vectors, coefficients);
    return Propagated{.transfer = std::move(transfer),
                      .bounces = bounces,
                      .remaining = remaining_after(*energy, total),
                      .last = energy->last,
                      .optional_work = std::move(optional_work)};
}

/// Adds bounces one after another, until at most `min_remaining` remains.
Propagated bounce_often(Transfer transfer, const TransportOperators& operators, int bounces,
                        double min_remaining, int threads, const Progress& progress) {
    const ColumnOperator bounce =
        bounce_operator(operators, transfer.layout.order, transfer.layout.channels(), threads);
    const auto coefficients = static_cast<std::size_t>(coefficient_count(transfer.layout.order));
    Propagated result;
    std::vector<float> now = transfer.vectors, next(now.size());
    double before = largest_norm(now, coefficients);
    while (result.bounces < bounces) {
        if (result.bounces == bounces - 1)
            result.optional_work = gather_beside(operators, transfer, threads);
        bounce.apply(now, next);
        for (std::size_t i = 0; i < next.size(); ++i)
            transfer.vectors[i] += next[i];
        std::swap(now, next);
        ++result.bounces;
        const double energy = largest_norm(now, coefficients);
        result.remaining = remaining_after({before, energy}, largest_norm(transfer.vectors, coefficients));
        before = result.last = energy;
        result.converged = result.remaining < min_remaining;
        if (result.converged)
            break;
        progress.update(static_cast<double>(result.bounces) / bounces);
    }
    if (result.bounces < bounces)
        result.optional_work = gather_beside(operators, transfer, threads);
    result.converged |= min_remaining == 0;
    result.transfer = std::move(transfer);
    return result;
}

/// Computes the sum over all bounces (docs/math.md, eq. 37).
Propagated bounce_endlessly(Transfer transfer, const TransportOperators& operators, int threads,
                            const Progress& progress) {
    // A few coefficients at a time, because the solver stores a vector for each of its steps.
    const int order = std::min(transfer.layout.order, 3), width = coefficient_count(order),
              coefficients = coefficient_count(transfer.layout.order), channels = transfer.layout.channels();
    const auto columns = static_cast<std::size_t>(channels * width);
    std::vector<float> some(transfer.receivers() * columns);
    const ColumnOperator bounce = bounce_operator(operators, order, channels, threads);
    Propagated result;
    for (int first = 0; first < coefficients; first += width) {
        progress.update(static_cast<double>(first) / coefficients);
        const auto exchange = [&](auto&& visit) { // the last group may have fewer coefficients
            for (std::size_t p = 0; p < transfer.receivers(); ++p)
                for (int c = 0; c < channels; ++c)
                    for (int k = 0; k < width; ++k)
                        visit(
                            some[p * columns + static_cast<std::size_t>(c * width + k)],
                            first + k < coefficients
                                ? &transfer.vector(p)[static_cast<std::size_t>(c * coefficients + first + k)]
                                : nullptr);
        };
        exchange([](float& here, const float* there) { here = there ? *there : 0.0f; });
        const KrylovResult solved = solve_fixed_point(
            bounce, some, {.columns = columns, .threads = threads, .check = [&] { progress.check(); }});
        exchange([](float here, float* there) {
            if (there)
                *there = here;
        });
        result.bounces = std::max(result.bounces, solved.applications);
        result.remaining = std::max(result.remaining, solved.remaining);
        result.converged = result.converged && solved.converged;
    }
    result.optional_work = gather_beside(operators, transfer, threads);
    result.transfer = std::move(transfer);
    return result;
}

/// Gathers `exit` transfer at the samples: one more bounce.
SampledLight bounce_to_samples(Transfer exit, TransportOperators operators, const LightAtSamples& sampled,
                               int threads) {
    if (sampled.last) {
        operators.gather = sampled.last;
        operators.product = nullptr;
    }
    const SurfaceFit& fit = *operators.fit;
    const TestValues& tests = sampled.of_rest;
    const int order = exit.layout.order;
    const std::size_t stride = exit.dimension(), count = tests.count();
    SampledLight light{.stride = stride,
                       .tests = count,
                       .sums = std::vector<float>(fit.equations.unknowns * stride),
                       .sharp = {},
                       .values = std::vector<float>(fit.samples.size() * count)};
    load_exit(operators, order, exit.vectors, threads);
    in_blocks<float>(operators.gather->rows(), stride, [&](std::size_t first, std::span<float> block) {
        gather_rows(operators, order, exit.vectors, {first, block}, threads);
        add_samples(fit.equations, first, std::span<const float>(block), stride, std::span(light.sums));
        for (std::size_t s = 0; s * stride < block.size(); ++s)
            tests.evaluate(block.subspan(s * stride, stride),
                           std::span(light.values).subspan((first + s) * count, count));
    });
    return light;
}

/// Includes the bounce to samples in the statistics of `exit`, whose sum began with `direct`.
void add_last_bounce(const SurfaceFit& fit, const SampledLight& rest, const Transfer& direct,
                     Propagated& exit) {
    const auto coefficients = static_cast<std::size_t>(coefficient_count(direct.layout.order));
    std::vector<float> x = rest.sums, last(exit.transfer.vectors.size());
    fit.smooth(std::span(x), rest.stride);
    spread_unknowns(fit.equations, std::span<const float>(x), rest.stride, std::span(last));
    double before = exit.last;
    if (exit.bounces == 0)
        before = largest_norm(direct.vectors, coefficients);
    for (std::size_t i = 0; i < last.size(); ++i)
        last[i] -= exit.transfer.vectors[i] - direct.vectors[i];
    const double energy = largest_norm(last, coefficients);
    exit.remaining =
        remaining_after({before, energy}, largest_norm(exit.transfer.vectors, coefficients) + energy);
    exit.last = energy;
    ++exit.bounces;
}

} // namespace

Propagated propagate(Transfer direct, const TransportOperators& operators, int bounces, int threads,
                     const Progress& progress) {
    if (operators.sources && operators.gather)
        return gather_once(std::move(direct), operators, threads);
    exit_from_incident(operators, direct.layout.order, direct.layout.channels(), direct.vectors, threads);
    if (!operators.gather || bounces == 0)
        return {.transfer = std::move(direct)};
    if (bounces != kEndlessBounces) {
        if (std::optional<Propagated> done = bounce_on_device(direct, operators, bounces, threads, progress))
            return std::move(*done);
        return bounce_often(std::move(direct), operators, bounces, 0, threads, progress);
    }
    // Media may return more light than they receive (docs/math.md, section 8): a solution of the equation is
    // then not necessarily the sum over bounces, so compute the sum itself.
    return operators.diffusion.empty()
               ? bounce_endlessly(std::move(direct), operators, threads, progress)
               : bounce_often(std::move(direct), operators, kMaxBounces, 1e-5, threads, progress);
}

SharpTransfer propagate_sharply(Transfer smooth, const LightAtSamples& light,
                                const TransportOperators& operators, int bounces, int threads,
                                const Progress& progress) {
    const SurfaceFit& fit = *operators.fit;
    const TransferLayout layout = smooth.layout;
    const std::size_t receivers = smooth.receivers();
    SharpTransfer sharp;
    std::optional<SampledLight> rest;
    if (operators.gather && bounces != 0) {
        const bool endless = bounces == kEndlessBounces;
        TransportOperators alone = operators;
        alone.optional_work.clear();
        if (!operators.sources)
            sharp.exit = propagate(smooth, alone, endless ? bounces : bounces - 1, threads, progress);
        const Transfer& sources = operators.sources ? *operators.sources : sharp.exit.transfer;
        sharp.exit.optional_work = gather_beside(operators, sources, threads);
        rest = bounce_to_samples(sources, operators, light, threads);
        if (!endless && !operators.sources)
            add_last_bounce(fit, *rest, smooth, sharp.exit);
    }
    std::optional<FitSolver> of_rest;
    if (rest && light.for_rest)
        of_rest.emplace(light.for_rest(*rest));
    const SharpLight values =
        SharpFit(fit, light.solver, of_rest ? *of_rest : light.solver, threads)
            .solve(light.of_direct, light.direct, &light.of_rest, rest ? &*rest : nullptr);
    const auto spread = [&](const std::vector<float>& x, std::size_t stride) {
        std::vector<float> of_receivers(receivers * stride);
        spread_unknowns(fit.equations, std::span<const float>(x), stride, std::span(of_receivers));
        return of_receivers;
    };
    const std::size_t few = light.direct.stride, many = layout.dimension();
    const std::vector<float> direct = spread(values.direct, few);
    Transfer& exit = sharp.exit.transfer;
    exit = rest ? Transfer{layout, spread(values.rest, many)} : zero_transfer(layout, receivers);
    for (std::size_t p = 0; p < receivers; ++p)
        for (std::size_t c = 0; c < many; ++c)
            exit.vectors[p * many + c] += direct[p * few + c % few];
    sharp.direct = {layout_of_one(layout.order, static_cast<int>(few) / coefficient_count(layout.order),
                                  layout.terms.front().kind),
                    direct};
    exit_from_incident(operators, layout.order, layout.channels(), exit.vectors, threads);
    return sharp;
}

void mix_sides(const Surfaces& surfaces, const SurfacePoint& point, std::size_t channels,
               std::span<float> front, std::span<const float> back) {
    // If the base color is nearly black, no finite transfer can represent transmitted light: it counts as
    // 1/255.
    constexpr float kMinBase = 1.0f / 255;
    const Scattering s = surfaces.scattering(point);
    const glm::vec3 base = surfaces.base_color(point);
    const std::size_t columns = front.size() / channels;
    for (std::size_t c = 0; c < channels; ++c) {
        const auto color = static_cast<glm::length_t>(c);
        const float scale = 1 / std::max(base[color], kMinBase);
        for (std::size_t i = c * columns; i < (c + 1) * columns; ++i)
            front[i] = scale * (s.reflected[color] * front[i] + s.transmitted[color] * back[i]);
    }
}

void add_transmission(Transfer& transfer, const Surfaces& surfaces, const TransportReceivers& receivers) {
    std::vector<bool> done(receivers.fronts);
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        if (!surfaces.transmits(t))
            continue;
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t front = surfaces.corners(t)[corner];
            if (done[front])
                continue;
            done[front] = true;
            const glm::vec2 uv(corner == 1 ? 1 : 0, corner == 2 ? 1 : 0);
            mix_sides(surfaces, {t, uv, receivers.receivers.areas[front]},
                      static_cast<std::size_t>(transfer.layout.channels()), transfer.vector(front),
                      transfer.vector(receivers.back_of(front)));
        }
    }
}

} // namespace prt
