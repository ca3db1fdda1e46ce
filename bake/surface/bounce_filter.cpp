#include "surface/bounce_filter.h"

#include "prt/support/parallel.h"
#include "surface/bend_weights.h"

#include <algorithm>

namespace prt {
namespace {

/// Noise over half of the difference between two halves of a net: the whole net has less, since its parts fit
/// together. Between 0.7 and 1 errors of four scenes differ by a fifth.
constexpr float kNoiseOfHalves = 0.85f;

/// A sample at a corner of each triangle side for the receiver there, once for each receiver that is asked
/// for.
SurfaceSamples samples_at_receivers(const BakePlan& plan, const std::vector<bool>& left_out,
                                    std::vector<std::uint32_t>& receivers) {
    const Surfaces& surfaces = plan.scene.surfaces();
    SurfaceSamples samples;
    std::vector<bool> done = left_out;
    for (const TriangleSide& side : triangle_sides(surfaces, *plan.transport, true)) {
        const glm::uvec3 corners = corner_receivers(surfaces, *plan.transport, side.triangle, side.back);
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t p = corners[i];
            if (p == kNoReceiver || done[p])
                continue;
            done[p] = true;
            samples.places.push_back(
                {side.triangle, side.back, {i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f}});
            samples.receivers.areas.push_back(plan.receivers().areas[p]);
            receivers.push_back(p);
        }
    }
    return samples;
}

/// Light that passes is more than what rays gathered.
void leave_out_sheets(const BakePlan& plan, std::vector<bool>& left_out) {
    const Surfaces& surfaces = plan.scene.surfaces();
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t)
        if (surfaces.transmits(t))
            for (const bool back : {false, true}) {
                const glm::uvec3 corners = corner_receivers(surfaces, *plan.transport, t, back);
                for (int i = 0; i < 3; ++i)
                    if (corners[i] != kNoReceiver)
                        left_out[corners[i]] = true;
            }
}

float bounced(const Transfer& all, const Transfer& unbounced, std::uint32_t p, std::size_t c) {
    return all.vector(p)[c] - unbounced.vector(p)[c % unbounced.dimension()];
}

} // namespace

BounceFilter::BounceFilter(const BakePlan& plan, const SharedPlaces& shared,
                           const std::vector<bool>& left_out)
    : plan_(plan) {
    std::vector<bool> out = left_out;
    leave_out_sheets(plan, out);
    const SurfaceSamples samples = samples_at_receivers(plan, out, receivers_);
    equations_ = fit_equations(plan.scene.surfaces(), *plan.transport, samples,
                               shared.first_of_each(plan.receivers().size()));
    weights_ = unknown_weights(equations_);
}

template <class Value>
std::vector<float> BounceFilter::sums(const TellingColumns& columns, Value&& value) const {
    const std::size_t count = columns.size();
    std::vector<float> sums(equations_.unknowns * count), row(count);
    for (std::size_t s = 0; s < receivers_.size(); ++s) {
        for (std::size_t i = 0; i < count; ++i)
            row[i] = columns.factors[i] * value(receivers_[s], columns.columns[i]);
        add_samples(equations_, s, std::span<const float>(row), count, std::span(sums));
    }
    return sums;
}

TellingColumns BounceFilter::telling(const Light& light) const {
    std::vector<double> squares(light.all.dimension());
    for (const std::uint32_t p : receivers_)
        for (std::size_t c = 0; c < squares.size(); ++c) {
            const auto value = static_cast<double>(bounced(light.all, light.unbounced, p, c));
            squares[c] += static_cast<double>(plan_.receivers().areas[p]) * value * value;
        }
    return brightest_columns(squares);
}

FitSolver BounceFilter::solver(const Light& light) const {
    const TellingColumns columns = telling(light);
    const std::size_t count = columns.size(), stride = light.all.dimension();
    std::vector<float> x = sums(
        columns, [&](std::uint32_t p, std::size_t c) { return bounced(light.all, light.unbounced, p, c); });
    std::vector<float> noise = sums(columns, [&](std::uint32_t p, std::size_t c) {
        return kNoiseOfHalves * (light.half[p * stride + c] - bounced(light.all, light.unbounced, p, c));
    });
    const FitSolver first(equations_, std::vector<float>(equations_.bends.size(), kFirstBendWeight));
    first.solve(x, count, plan_.options.threads, FitSolver::kEstimate);
    first.solve(noise, count, plan_.options.threads, FitSolver::kEstimate);
    return {equations_, bend_weights(equations_, x, noise, count)};
}

void BounceFilter::limit(std::span<const float> means, std::size_t columns, std::span<float> x) const {
    std::vector<float> low(means.begin(), means.end()), high = low;
    for (const Bend& bend : equations_.bends)
        for (const std::uint32_t u : bend.unknowns)
            for (const std::uint32_t v : bend.unknowns)
                for (std::size_t c = 0; u != v && c < columns; ++c) {
                    low[u * columns + c] = std::min(low[u * columns + c], means[v * columns + c]);
                    high[u * columns + c] = std::max(high[u * columns + c], means[v * columns + c]);
                }
    for (std::size_t i = 0; i < x.size(); ++i)
        // Exact zeros stay: the filter adds no light where no ray met any.
        x[i] = means[i] == 0 ? 0 : std::clamp(x[i], low[i], high[i]);
}

void BounceFilter::apply(Transfer& light, const Transfer& unbounced, std::span<const float> half) const {
    constexpr std::size_t kBlock = 8; // columns of the solver, which keeps little in memory
    const FitSolver fit = solver({light, unbounced, half});
    const std::size_t stride = light.dimension();
    parallel_for((stride + kBlock - 1) / kBlock, 1, plan_.options.threads,
                 [&](std::size_t begin, std::size_t end) {
                     for (std::size_t block = begin; block < end; ++block) {
                         TellingColumns columns;
                         for (std::size_t c = block * kBlock; c < std::min(stride, (block + 1) * kBlock); ++c)
                             columns.columns.push_back(c);
                         const std::size_t count = columns.size();
                         columns.factors.assign(count, 1.0f);
                         std::vector<float> x = sums(columns, [&](std::uint32_t p, std::size_t c) {
                             return bounced(light, unbounced, p, c);
                         });
                         std::vector<float> means = x;
                         for (std::size_t i = 0; i < means.size(); ++i)
                             means[i] = weights_[i / count] > 0 ? means[i] / weights_[i / count] : 0;
                         fit.solve(x, count, 1, FitSolver::kEstimate);
                         limit(means, count, x);
                         for (const std::uint32_t p : receivers_)
                             for (std::size_t i = 0; i < count; ++i) {
                                 const std::size_t c = columns.columns[i];
                                 light.vector(p)[c] = unbounced.vector(p)[c % unbounced.dimension()] +
                                                      x[equations_.unknown_of[p] * count + i];
                             }
                     }
                 });
}

} // namespace prt
