// Alternates between codes for clusters and clusters for codes, like the generalised Lloyd algorithm (Gersho
// and Gray 1992), with weights and bases on the grids of the file (docs/math.md, eq. 25 to 27).

#include "compress/coding/alternation.h"

#include "compress/coding/refit.h"
#include "prt/core/clustered_bases.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace prt {
namespace {

/// Returns the number of axes of each group; groups are consecutive.
std::vector<int> axes_of_groups(const PointBlocks& points) {
    if (points.scales.all_alike())
        return {static_cast<int>(points.dimension)};
    std::vector<int> axes(points.scales.groups, 0);
    for (const std::uint8_t group : points.scales.group_of)
        ++axes[group];
    return axes;
}

/// Returns the maximum magnitude in cluster `k` along each axis; rows count half.
std::vector<double> largest_values(const AffineClusters& clusters, std::size_t k) {
    std::vector<double> largest(clusters.dimension, 0);
    for_rows(clusters, k, [&](const float* row, int factor) {
        for (std::size_t i = 0; i < clusters.dimension; ++i)
            largest[i] = std::max(largest[i], static_cast<double>(std::abs(row[i])) / factor);
    });
    return largest;
}

/// Returns the cost of a squared error along the axes of each group, summed over the points of each cluster:
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

/// Returns the steps of the bases at which rounding adds `share` of the squared error. A point's code is the
/// sum of its mean and of m rows times weights; rows are rounded to twice the step. Steps are finer where the
/// total cost of errors is higher: inversely proportional to its square root, which minimises the bits for a
/// given error.
RowSteps basis_steps(const PointBlocks& points, std::span<const float> significance,
                     const CodedClusters& coded, double share) {
    const AffineClusters& clusters = coded.clusters;
    RowSteps steps;
    steps.axes = axes_of_groups(points);
    const std::size_t groups = steps.groups();
    const std::vector<double> costs = costs_of_groups(points, significance, coded.codes, clusters.clusters());
    double noise = 0; // noise of steps of 1 over the root of the costs
    for (const int m : clusters.components)
        noise += (static_cast<double>(1 + clusters.predictors) + 4 * tuning::kMeanSquareWeight * m) *
                 static_cast<double>(clusters.dimension) / 12;
    const double error = total_error(significance, coded.codes.errors);
    const double step = noise > 0 ? std::sqrt(share * error / noise) : 0; // for errors of cost 1
    std::vector<double> dearest(groups, 0);
    for (std::size_t at = 0; at < costs.size(); ++at)
        dearest[at % groups] = std::max(dearest[at % groups], costs[at]);
    constexpr double kMaxValue = (1 << (kMaxRowBits - 1)) - 1, kMinStep = 1e-30;
    std::vector<double> wanted(clusters.clusters() * groups, 0), smallest(wanted.size(), kMinStep);
    for (std::size_t k = 0; k < clusters.clusters(); ++k) {
        const std::vector<double> largest = largest_values(clusters, k);
        std::size_t i = 0;
        for (std::size_t g = 0; g < groups; ++g) {
            for (const std::size_t end = i + static_cast<std::size_t>(steps.axes[g]); i < end; ++i)
                smallest[k * groups + g] = std::max(smallest[k * groups + g], largest[i] / kMaxValue);
            const double cost = std::max(costs[k * groups + g], 1e-6 * dearest[g]);
            wanted[k * groups + g] = cost > 0 ? step / std::sqrt(cost) : 0;
        }
    }
    steps.least = std::numeric_limits<double>::infinity();
    for (std::size_t at = 0; at < wanted.size(); ++at)
        steps.least = std::min(steps.least, std::max(wanted[at], smallest[at]));
    steps.least = static_cast<double>(static_cast<float>(steps.least)); // rounded to float, like the value in
                                                                        // the file
    for (std::size_t at = 0; at < wanted.size(); ++at)
        steps.exponents.push_back(static_cast<int>(
            std::max({0.0, std::ceil(std::log2(smallest[at] / steps.least) - 1e-9),
                      std::round(std::log2(std::max(wanted[at], kMinStep) / steps.least))})));
    return steps;
}

/// Performs one round. Returns the error.
double improve(const PointBlocks& points, std::span<const float> significance,
               const AlternationOptions& options, CodedClusters& coded) {
    const Codes before = coded.codes;
    encode_all(points, options, coded);
    keep_better(points, coded.clusters, before, coded.codes, options.threads);
    return total_error(significance, coded.codes.errors);
}

/// Sorts points along the group in which their scales differ most: a single subspace represents light of very
/// different magnitudes badly.
void sort_by_scale(const PointScales& scales, std::vector<std::uint32_t>& members) {
    std::size_t widest = 0;
    float most = 0;
    for (std::size_t g = 0; g < scales.groups; ++g) {
        const auto [least, largest] =
            std::ranges::minmax(members, {}, [&](std::uint32_t p) { return scales.of(p)[g]; });
        const float ratio = scales.of(largest)[g] / scales.of(least)[g];
        if (ratio > most) {
            most = ratio;
            widest = g;
        }
    }
    std::ranges::stable_sort(members, {}, [&](std::uint32_t p) { return scales.of(p)[widest]; });
}

/// Makes cluster `to`, which has taken points of `from`, a candidate for points of the neighbourhood of
/// `from`.
void become_neighbours(std::uint32_t from, std::uint32_t to, ClusterLists& candidates) {
    candidates[to] = candidates[from];
    if (std::ranges::find(candidates[to], to) == candidates[to].end())
        candidates[to].push_back(to);
    for (const std::uint32_t near : candidates[to])
        if (near != to && std::ranges::find(candidates[near], to) == candidates[near].end())
            candidates[near].push_back(to);
}

/// Merges clusters whose points others serve nearly as well, and moves half of the points of clusters with
/// large errors into them.
class Splitter {
public:
    Splitter(const PointBlocks& points, std::span<const float> significance,
             const AlternationOptions& options, CodedClusters& coded)
        : points_(points), significance_(significance), options_(options), coded_(coded),
          elsewhere_(coded.codes), members_(members_of(coded.codes.clusters, coded.clusters.clusters())) {
        ClusterLists others = *options.candidates;
        for (std::uint32_t k = 0; k < others.size(); ++k)
            std::erase(others[k], k);
        encode_points(points, coded.clusters, others, elsewhere_, options.threads);
        errors_.resize(members_.size());
        losses_.resize(members_.size());
        for (std::size_t p = 0; p < points.count; ++p) {
            const std::uint32_t k = coded.codes.clusters[p];
            const auto share = static_cast<double>(significance[p]);
            errors_[k] += share * static_cast<double>(coded.codes.errors[p]);
            losses_[k] += share * static_cast<double>(elsewhere_.errors[p] - coded.codes.errors[p]);
        }
    }

    void run() {
        constexpr std::size_t kSplit = 4; // splits of fewer points gain nothing
        std::vector<std::uint32_t> cheapest(members_.size());
        std::iota(cheapest.begin(), cheapest.end(), 0U);
        std::ranges::stable_sort(cheapest, {}, [&](std::uint32_t k) { return losses_[k]; });
        std::vector<bool> stays(members_.size(), false);
        for (const std::uint32_t merged : cheapest) {
            if (stays[merged])
                continue;
            const auto worst =
                static_cast<std::uint32_t>(std::ranges::max_element(errors_) - errors_.begin());
            if (worst == merged || members_[worst].size() < kSplit ||
                !(tuning::kSplitGain * errors_[worst] > losses_[merged]))
                break;
            for (const std::uint32_t p : members_[merged])
                stays[elsewhere_.clusters[p]] = true;
            stays[worst] = true;
            merge(merged);
            split(worst, merged);
        }
    }

private:
    void merge(std::uint32_t k) {
        for (const std::uint32_t p : members_[k]) {
            coded_.codes.clusters[p] = elsewhere_.clusters[p];
            coded_.codes.weights.copy(elsewhere_.weights, p);
            members_[elsewhere_.clusters[p]].push_back(p);
        }
        members_[k].clear();
    }

    void split(std::uint32_t from, std::uint32_t to) {
        copy_cluster(coded_.clusters, from, coded_.clusters, to);
        become_neighbours(from, to, *options_.candidates);
        std::vector<std::uint32_t>& members = members_[from];
        sort_by_scale(points_.scales, members);
        const auto half = members.begin() + static_cast<std::ptrdiff_t>(members.size() / 2);
        members_[to].assign(half, members.end());
        members.erase(half, members.end());
        for (const std::uint32_t p : members_[to])
            coded_.codes.clusters[p] = to;
        errors_[to] = errors_[from] *= 0.25; // proportional to the squared extent of a half
    }

    const PointBlocks& points_;
    std::span<const float> significance_;
    const AlternationOptions& options_;
    CodedClusters& coded_;
    Codes elsewhere_; ///< the best code of each point in another cluster
    ClusterLists members_;
    std::vector<double> errors_, losses_; ///< [clusters]; loss if all points move to other clusters
};

} // namespace

void settle(const PointBlocks& points, std::span<const float> significance, const AlternationOptions& options,
            int rounds, CodedClusters& coded) {
    const bool splits = options.candidates && !options.stay && coded.clusters.clusters() > 1;
    double before = total_error(significance, coded.codes.errors);
    for (int round = 0; round < rounds; ++round) {
        const bool even = round % 2 == 0; // the effect of a split is visible one round later
        if (splits && even)
            Splitter(points, significance, options, coded).run();
        refit(points, significance, coded.codes, coded.clusters, options.threads);
        const double after = improve(points, significance, options, coded);
        if (!even && after > (1 - tuning::kSettled) * before)
            break;
        before = even ? before : after;
    }
}

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
        const double error = improve(points, significance, options, coded);
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
