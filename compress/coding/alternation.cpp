// Codes for clusters and clusters for codes in turn, as the generalised Lloyd algorithm does (Gersho and Gray
// 1992), with weights and bases on the grids of the file (docs/math.md, eq. 25 to 27).

#include "coding/alternation.h"

#include "coding/refit.h"
#include "prt/coded_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prt {
namespace {

/// Axes of each group of points, one group behind the other.
std::vector<int> axes_of_groups(const PointBlocks& points) {
    if (points.scales.all_alike())
        return {static_cast<int>(points.dimension)};
    std::vector<int> axes(points.scales.groups, 0);
    for (const std::uint8_t group : points.scales.group_of)
        ++axes[group];
    return axes;
}

/// Largest values of cluster `k` along each axis, of rows the half.
std::vector<double> largest_values(const AffineClusters& clusters, std::size_t k) {
    std::vector<double> largest(clusters.dimension, 0);
    const auto see = [&](const float* row, double factor) {
        for (std::size_t i = 0; i < clusters.dimension; ++i)
            largest[i] = std::max(largest[i], factor * static_cast<double>(std::abs(row[i])));
    };
    see(clusters.mean(k), 1);
    for (std::size_t g = 0; g < clusters.guides; ++g)
        see(clusters.slope(k, g), 1);
    for (std::size_t j = 0; j < clusters.components_of(k); ++j)
        see(clusters.row(k, j), 0.5);
    return largest;
}

/// What a squared error along the axes of each group costs, summed over the points of each cluster:
/// [clusters][groups].
std::vector<double> costs_of_groups(const PointBlocks& points, std::span<const float> significance,
                                    const Codes& codes, std::size_t clusters) {
    const std::size_t groups = std::max<std::size_t>(points.scales.groups, 1);
    std::vector<double> costs(clusters * groups, 0);
    for (std::size_t p = 0; p < points.count; ++p)
        for (std::size_t g = 0; g < groups; ++g) {
            const double scale = points.scales.all_alike() ? 1 : static_cast<double>(points.scales.of(p)[g]);
            costs[codes.clusters[p] * groups + g] += static_cast<double>(significance[p]) * scale * scale;
        }
    return costs;
}

/// The steps of the bases at which rounding adds `share` of the squared error: a point's code is the sum of
/// its mean and of m rows times weights, which are rounded to twice the step. Where errors cost more in sum,
/// steps are finer: by the square root, which for as much error takes least bits.
RowSteps basis_steps(const PointBlocks& points, std::span<const float> significance,
                     const CodedClusters& coded, double share) {
    const AffineClusters& clusters = coded.clusters;
    RowSteps steps;
    steps.axes = axes_of_groups(points);
    const std::size_t groups = steps.groups();
    const std::vector<double> costs = costs_of_groups(points, significance, coded.codes, clusters.clusters());
    double noise = 0; // of steps of 1 over the root of the costs
    for (const int m : clusters.components)
        noise += (static_cast<double>(1 + clusters.guides) + 4 * tuning::kMeanSquareWeight * m) *
                 static_cast<double>(clusters.dimension) / 12;
    const double error = total_error(significance, coded.codes.errors);
    const double step = noise > 0 ? std::sqrt(share * error / noise) : 0; // where errors cost 1
    const double dearest = costs.empty() ? 0 : *std::max_element(costs.begin(), costs.end());
    constexpr double kMost = (1 << (kMostRowBits - 1)) - 1, kLeastStep = 1e-30;
    std::vector<double> wanted(clusters.clusters() * groups, 0), least(wanted.size(), kLeastStep);
    for (std::size_t k = 0; k < clusters.clusters(); ++k) {
        const std::vector<double> largest = largest_values(clusters, k);
        std::size_t i = 0;
        for (std::size_t g = 0; g < groups; ++g) {
            for (const std::size_t end = i + static_cast<std::size_t>(steps.axes[g]); i < end; ++i)
                least[k * groups + g] = std::max(least[k * groups + g], largest[i] / kMost);
            const double cost = std::max(costs[k * groups + g], 1e-6 * dearest);
            wanted[k * groups + g] = cost > 0 ? step / std::sqrt(cost) : 0;
        }
    }
    steps.least = std::numeric_limits<double>::infinity();
    for (std::size_t at = 0; at < wanted.size(); ++at)
        steps.least = std::min(steps.least, std::max(wanted[at], least[at]));
    steps.least = static_cast<double>(static_cast<float>(steps.least)); // as the file has it
    for (std::size_t at = 0; at < wanted.size(); ++at)
        steps.exponents.push_back(static_cast<int>(
            std::max({0.0, std::ceil(std::log2(least[at] / steps.least) - 1e-9),
                      std::round(std::log2(std::max(wanted[at], kLeastStep) / steps.least))})));
    return steps;
}

} // namespace

void encode_all(const PointBlocks& points, const AlternationOptions& options, CodedClusters& coded) {
    if (options.stay)
        encode_in_place(points, coded.clusters, coded.codes, options.threads);
    else if (options.candidates)
        encode_points(points, coded.clusters, *options.candidates, coded.codes, options.threads);
    else
        encode_points(points, coded.clusters,
                      neighbours_of_codes(coded.clusters, tuning::kNeighboursOfCodes, options.threads),
                      coded.codes, options.threads);
}

void alternate(const PointBlocks& points, std::span<const float> significance,
               const AlternationOptions& options, const Progress& progress, CodedClusters& coded) {
    const bool rounds_bases = options.basis_share > 0;
    CodedClusters best;
    double least = std::numeric_limits<double>::infinity();
    for (int round = 0; round < options.rounds; ++round) {
        progress.update(static_cast<double>(round) / options.rounds);
        const bool rounded = rounds_bases && round >= options.rounded_from;
        refit(points, significance, coded.codes, coded.clusters, options.threads);
        if (rounded) {
            coded.steps = basis_steps(points, significance, coded, options.basis_share);
            round_rows(coded.clusters, coded.steps);
        }
        const Codes before = coded.codes;
        encode_all(points, options, coded);
        keep_better(points, coded.clusters, before, coded.codes, options.threads);
        const double error = total_error(significance, coded.codes.errors);
        if (options.trace)
            options.trace(CodingRound{rounded, error});
        if (rounded == rounds_bases && error < least) {
            least = error;
            best = coded;
        }
    }
    coded = std::move(best);
}

} // namespace prt
