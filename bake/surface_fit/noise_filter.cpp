// Filters light with the equations of a surface fit that has a sample at each receiver.

#include "bake/surface_fit/noise_filter.h"

#include "bake/surface_fit/smoothness_weights.h"
#include "bake/surface_fit/surface_fit.h"
#include "bake/trace/scrambles.h"
#include "prt/core/sh_basis.h"
#include "runtime/core/support/parallel.h"

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// Creates one sample for each receiver that is not left out, at a corner of a triangle side.
SurfaceSamples samples_at_receivers(const BakePlan& plan, const std::vector<bool>& left_out,
                                    std::vector<std::uint32_t>& receivers) {
    const Surfaces& surfaces = plan.scene.surfaces();
    SurfaceSamples samples;
    std::vector<bool> done(left_out.size(), true);
    for (const std::uint32_t p : receivers_on_surfaces(plan.receivers()))
        done[p] = left_out[p];
    for (const TriangleSide& side : triangle_sides(surfaces, *plan.transport, true)) {
        const glm::uvec3 corners = corner_receivers(surfaces, *plan.transport, side.triangle, side.back);
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t p = corners[i];
            if (p == kNoReceiver || done[p])
                continue;
            done[p] = true;
            samples.positions.push_back(
                {side.triangle, side.back, {i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f}});
            samples.receivers.areas.push_back(plan.receivers().areas[p]);
            receivers.push_back(p);
        }
    }
    return samples;
}

/// Leaves out receivers on thin sheets: transmitted light is not in the light gathered by their rays.
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

} // namespace

NoiseFilter::NoiseFilter(FitEquations equations, std::vector<std::uint32_t> positions, int threads)
    : equations_(std::move(equations)), positions_(std::move(positions)),
      weights_(unknown_weights(equations_)), threads_(threads) {
    // An unknown without samples is 0 and would darken its neighbours.
    std::erase_if(equations_.second_differences, [&](const SecondDifference& second_difference) {
        return std::ranges::any_of(second_difference.unknowns,
                                   [&](std::uint32_t u) { return !(weights_[u] > 0); });
    });
}

NoiseFilter vertex_filter(const BakePlan& plan, const SharedPositions& shared,
                          const std::vector<bool>& left_out) {
    std::vector<bool> out = left_out;
    leave_out_sheets(plan, out);
    std::vector<std::uint32_t> receivers;
    const SurfaceSamples samples = samples_at_receivers(plan, out, receivers);
    return {fit_equations(plan.scene.surfaces(), *plan.transport, samples,
                          shared.first_of_each(plan.receivers().size())),
            std::move(receivers), plan.options.threads};
}

std::vector<float> NoiseFilter::sums(const RepresentativeColumns& columns, const Values& values) const {
    const std::size_t count = columns.size();
    std::vector<float> sums(equations_.unknowns * count), row(count);
    for (std::size_t s = 0; s < positions_.size(); ++s) {
        for (std::size_t i = 0; i < count; ++i)
            row[i] = columns.factors[i] * values(positions_[s], columns.columns[i]);
        add_samples(equations_, s, std::span<const float>(row), count, std::span(sums));
    }
    return sums;
}

RepresentativeColumns NoiseFilter::brightest(const Values& light, std::size_t columns) const {
    std::vector<double> squares(columns);
    for (std::size_t s = 0; s < positions_.size(); ++s)
        for (std::size_t c = 0; c < columns; ++c) {
            const auto value = static_cast<double>(light(positions_[s], c));
            squares[c] += static_cast<double>(equations_.rows[s].area) * value * value;
        }
    return brightest_columns(squares);
}

FitSolver NoiseFilter::fit(const Values& light, const RepresentativeColumns& columns,
                           const Values& noise_of) const {
    const std::size_t count = columns.size();
    std::vector<float> x = sums(columns, light), noise = sums(columns, noise_of);
    const FitSolver first(equations_,
                          std::vector<float>(equations_.second_differences.size(), kFirstSmoothnessWeight));
    first.solve(x, count, threads_, FitSolver::kEstimate);
    first.solve(noise, count, threads_, FitSolver::kEstimate);
    return {equations_, smoothness_weights(equations_, x, noise, count)};
}

double NoiseFilter::norm(const FitSolver& solver, const RepresentativeColumns& columns,
                         const Values& values) const {
    const std::size_t count = columns.size();
    std::vector<float> x = sums(columns, values);
    solver.solve(x, count, threads_, FitSolver::kRough);
    double sum = 0;
    for (std::size_t u = 0; u < weights_.size(); ++u)
        sum += static_cast<double>(weights_[u]) *
               squared_norm(std::span<const float>(x).subspan(u * count, count));
    return std::sqrt(sum);
}

void NoiseFilter::limit(std::span<const float> means, std::size_t columns, std::span<float> x) const {
    std::vector<float> low(means.begin(), means.end()), high = low;
    for (const SecondDifference& second_difference : equations_.second_differences)
        for (const std::uint32_t u : second_difference.unknowns)
            for (const std::uint32_t v : second_difference.unknowns)
                for (std::size_t c = 0; u != v && c < columns; ++c) {
                    low[u * columns + c] = std::min(low[u * columns + c], means[v * columns + c]);
                    high[u * columns + c] = std::max(high[u * columns + c], means[v * columns + c]);
                }
    for (std::size_t i = 0; i < x.size(); ++i)
        // Exact zeros are kept: the filter adds no light where no ray found any.
        x[i] = means[i] == 0 ? 0 : std::clamp(x[i], low[i], high[i]);
}

void NoiseFilter::apply_to(const FitSolver& solver, const RepresentativeColumns& columns, const Values& light,
                           const Write& write) const {
    const std::size_t count = columns.size();
    std::vector<float> x = sums(columns, light), means = x;
    smooth(weights_, std::span(means), count);
    solver.solve(x, count, 1, FitSolver::kRough);
    limit(means, count, x);
    for (const std::uint32_t position : positions_) {
        const std::uint32_t u = equations_.unknown_of[position];
        for (std::size_t i = 0; i < count && weights_[u] > 0; ++i)
            write(position, columns.columns[i], x[u * count + i]);
    }
}

void NoiseFilter::apply(const FitSolver& solver, std::size_t columns, const Values& light,
                        const Write& write) const {
    constexpr std::size_t kColumnsAtOnce = 8; // columns of the solver; blocks limit the memory
    parallel_for((columns + kColumnsAtOnce - 1) / kColumnsAtOnce, 1, threads_,
                 [&](std::size_t begin, std::size_t end) {
                     for (std::size_t block = begin; block < end; ++block) {
                         RepresentativeColumns some;
                         for (std::size_t c = block * kColumnsAtOnce;
                              c < std::min(columns, (block + 1) * kColumnsAtOnce); ++c)
                             some.columns.push_back(c);
                         some.factors.assign(some.size(), 1.0f);
                         apply_to(solver, some, light, write);
                     }
                 });
}

void NoiseFilter::apply(const FitSolver& solver, Transfer& light) const {
    apply(
        solver, light.dimension(), [&](std::uint32_t p, std::size_t c) { return light.vector(p)[c]; },
        [&](std::uint32_t p, std::size_t c, float value) { light.vector(p)[c] = value; });
}

} // namespace prt
