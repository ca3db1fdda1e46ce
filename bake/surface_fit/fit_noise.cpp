// Estimates the noise of sums over samples with random signs, and chooses smoothness weights by it.

#include "bake/surface_fit/fit_noise.h"

#include "bake/surface_fit/smoothness_weights.h"
#include "bake/trace/sample_sequence.h"
#include "bake/trace/scrambles.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace prt {
namespace {

constexpr std::size_t kBlock = 8; ///< columns that the solver processes together

/// Subtracts the fitted values at `x` [unknowns][columns] from sums of samples with the signs of groups. The
/// result is the sums of residuals.
void subtract_with_signs(const SurfaceSamples& samples, const FitEquations& equations,
                         std::span<const float> x, NoisySums& sums, std::uint64_t seed) {
    std::vector<float> fitted(sums.columns);
    for (std::size_t s = 0; s < samples.size(); ++s) {
        const FitRow& row = equations.rows[s];
        std::ranges::fill(fitted, 0.0f);
        for (std::size_t i = 0; i < 3; ++i)
            if (row.unknowns[i] != kNoReceiver)
                for (std::size_t c = 0; c < sums.columns; ++c)
                    fitted[c] += row.shares[i] * x[row.unknowns[i] * sums.columns + c];
        add_samples(equations, s, std::span<const float>(fitted), sums.columns, std::span(sums.with_signs),
                    -sign_of_group(s / samples.layers, seed));
    }
}

} // namespace

float sign_of_group(std::size_t group, std::uint64_t seed) {
    return receiver_seed(static_cast<std::uint32_t>(group), seed + 6 * kSecondScramble) & 1 ? 1.0f : -1.0f;
}

RepresentativeColumns columns_of_sky(std::size_t stride) {
    constexpr std::size_t kFirst = 4;
    RepresentativeColumns columns;
    const std::size_t first = std::min(stride, kFirst), rest = stride - first,
                      others = std::min(rest, kBlock - kFirst);
    for (std::size_t c = 0; c < first; ++c)
        columns.columns.push_back(c);
    for (std::size_t i = 0; i < others; ++i)
        columns.columns.push_back(first + (2 * i + 1) * rest / (2 * others));
    columns.factors.assign(columns.size(), 1.0f);
    for (std::size_t i = first; i < columns.size(); ++i)
        columns.factors[i] = std::sqrt(static_cast<float>(rest) / static_cast<float>(others));
    return columns;
}

RepresentativeColumns brightest_columns(std::span<const double> squares) {
    std::vector<std::size_t> order(squares.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater{}, [&](std::size_t c) { return squares[c]; });
    RepresentativeColumns columns;
    for (std::size_t i = 0; i < std::min(order.size(), kBlock) && squares[order[i]] > 0; ++i) {
        columns.columns.push_back(order[i]);
        columns.factors.push_back(static_cast<float>(1 / std::sqrt(squares[order[i]])));
    }
    return columns;
}

NoiseSolver noise_solver(const SurfaceSamples& samples, const FitEquations& equations, NoisySums sums,
                         std::uint64_t seed, int threads) {
    const FitSolver first(equations,
                          std::vector<float>(equations.second_differences.size(), kFirstSmoothnessWeight));
    std::vector<float>& x = sums.plain;
    first.solve(x, sums.columns, threads, FitSolver::kEstimate);
    subtract_with_signs(samples, equations, x, sums, seed);
    std::vector<float> noise = sums.with_signs;
    first.solve(noise, sums.columns, threads, FitSolver::kEstimate);
    return {FitSolver(equations, smoothness_weights(equations, x, noise, sums.columns)),
            std::move(sums.with_signs)};
}

FitSolver lamp_solver(const SurfaceSamples& samples, const FitEquations& equations,
                      std::span<const float> values, std::size_t columns, std::uint64_t seed, int threads) {
    std::vector<double> squares(columns);
    for (std::size_t s = 0; s < samples.size(); ++s)
        for (std::size_t c = 0; c < columns; ++c) {
            const auto value = static_cast<double>(values[s * columns + c]);
            squares[c] += static_cast<double>(equations.rows[s].area) * value * value;
        }
    const RepresentativeColumns some = brightest_columns(squares);
    NoisySums sums{some.size(), std::vector<float>(equations.unknowns * some.size()), {}};
    sums.with_signs = sums.plain;
    std::vector<float> row(some.size());
    for (std::size_t s = 0; s < samples.size(); ++s) {
        for (std::size_t i = 0; i < some.size(); ++i)
            row[i] = some.factors[i] * values[s * columns + some.columns[i]];
        add_samples(equations, s, std::span<const float>(row), some.size(), std::span(sums.plain));
        add_samples(equations, s, std::span<const float>(row), some.size(), std::span(sums.with_signs),
                    sign_of_group(s / samples.layers, seed));
    }
    return std::move(noise_solver(samples, equations, std::move(sums), seed, threads).solver);
}

} // namespace prt
