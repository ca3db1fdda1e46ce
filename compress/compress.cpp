#include "prt/compress.h"

#include "encode.h"
#include "kmeans.h"
#include "local_pca.h"
#include "prt/error.h"
#include "prt/parallel.h"
#include "prt/sh.h"
#include "prt/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace prt {
namespace {

void check(const Transfer& transfer, const CompressOptions& options) {
    check_order(transfer.order);
    if (options.clusters < 1 || options.clusters > 65536)
        throw Error("clusters must lie in 1..65536, not " + std::to_string(options.clusters));
    if (options.components < 0 || static_cast<std::size_t>(options.components) > transfer.dimension())
        throw Error("components must lie in 0.." + std::to_string(transfer.dimension()) +
                    ", the dimension of the transfer vectors, not " + std::to_string(options.components));
    if (transfer.receivers() == 0)
        throw Error("there are no receivers to compress");
    if (!std::all_of(transfer.vectors.begin(), transfer.vectors.end(),
                     [](float v) { return std::isfinite(v); }))
        throw Error("the transfer holds values that are not finite");
}

/// Receivers that count, and their weights. Where no receiver has an area all count alike.
struct Training {
    std::vector<std::uint32_t> receivers;
    std::vector<float> weights;

    explicit Training(std::span<const float> areas) {
        for (std::uint32_t p = 0; p < areas.size(); ++p)
            if (areas[p] > 0) {
                receivers.push_back(p);
                weights.push_back(areas[p]);
            }
        if (receivers.empty()) {
            receivers.resize(areas.size());
            std::iota(receivers.begin(), receivers.end(), 0u);
            weights.assign(areas.size(), 1.0f);
        }
    }
};

/// Weighted squared distance of all points to their clusters, in double, summed in a fixed order.
double exact_error(const PointBlocks& points, std::span<const float> weights, const ClusterModels& models,
                   std::span<const std::uint32_t> clusters, int threads) {
    constexpr std::size_t kGrain = 1024;
    std::vector<double> sums((points.count + kGrain - 1) / kGrain, 0);
    parallel_for(points.count, kGrain, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<double> w(models.max_components);
        for (std::size_t p = begin; p < end; ++p)
            sums[begin / kGrain] +=
                static_cast<double>(weights[p]) * project_point(points, p, models, clusters[p], w);
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

/// Which of `count` clusters have points.
std::vector<bool> clusters_in_use(std::span<const std::uint32_t> clusters, std::size_t count) {
    std::vector<bool> used(count, false);
    for (const std::uint32_t k : clusters)
        used[k] = true;
    return used;
}

/// Moves clusters that lost all their points to the points that are coded worst. Returns whether any moved.
bool revive_empty(const PointBlocks& points, std::span<const float> weights, const Assignment& assignment,
                  ClusterModels& models) {
    const std::vector<bool> used = clusters_in_use(assignment.clusters, models.clusters());
    const auto empty = static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
    if (empty == 0)
        return false;
    std::vector<std::uint32_t> worst(points.count);
    std::iota(worst.begin(), worst.end(), 0u);
    const std::size_t wanted = std::min(empty, points.count);
    std::partial_sort(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(wanted), worst.end(),
                      [&](std::uint32_t a, std::uint32_t b) {
                          const float ea = weights[a] * assignment.errors[a],
                                      eb = weights[b] * assignment.errors[b];
                          return ea != eb ? ea > eb : a < b;
                      });
    std::size_t next = 0;
    for (std::size_t k = 0; k < models.clusters() && next < wanted; ++k) {
        if (used[k] || !(assignment.errors[worst[next]] > 0))
            continue;
        points.copy_point(worst[next], models.mean(k));
        models.components[k] = 0;
        ++next;
    }
    return next > 0;
}

/// Clustered PCA from vector quantisation: fit every cluster's subspace, give every point the nearest,
/// repeat. Directions come one at a time, two rounds each, which finds better optima than starting with all
/// of them; then rounds at the full number until nothing is gained. Returns relative L2 errors of the latter
/// rounds.
std::vector<double> iterate(const PointBlocks& points, std::span<const float> weights,
                            const CompressOptions& options, ClusterModels& models,
                            std::vector<std::uint32_t>& clusters, const Progress& progress) {
    double norm = 0;
    for (std::size_t p = 0; p < points.count; ++p)
        for (std::size_t i = 0; i < points.dimension; ++i)
            norm += static_cast<double>(weights[p]) * static_cast<double>(points.coordinate(p, i)) *
                    static_cast<double>(points.coordinate(p, i));
    clusters = assign(points, models, options.threads).clusters;
    const int growing_rounds = 2 * std::max(0, options.components - 1);
    const int expected_rounds = growing_rounds + 40;

    std::vector<double> history;
    double least = std::numeric_limits<double>::infinity();
    for (int round = 0; round < growing_rounds + options.max_iterations; ++round) {
        progress.update(std::min(0.99, static_cast<double>(round) / expected_rounds));
        const bool growing = round < growing_rounds;
        ClusterModels fitted = models;
        fit_local_pca(points, weights, clusters, growing ? 1 + round / 2 : options.components, fitted,
                      options.threads);
        if (growing) {
            models = std::move(fitted);
        } else {
            const double error = exact_error(points, weights, fitted, clusters, options.threads);
            if (error > least)
                break; // rounding: nothing left to gain
            models = std::move(fitted);
            history.push_back(norm > 0 ? std::sqrt(error / norm) : 0);
            const bool converged = error >= least * (1 - options.tolerance);
            least = error;
            if (error == 0 || converged || round + 1 == growing_rounds + options.max_iterations)
                break;
        }
        Assignment next = assign(points, models, options.threads);
        if (revive_empty(points, weights, next, models))
            next = assign(points, models, options.threads);
        clusters = std::move(next.clusters);
    }
    return history;
}

/// Takes out clusters without points and renumbers the others.
void drop_empty(ClusterModels& models, std::vector<std::uint32_t>& clusters) {
    std::vector<std::uint32_t> new_index(models.clusters(), 0);
    const std::vector<bool> used = clusters_in_use(clusters, models.clusters());
    ClusterModels kept(static_cast<std::size_t>(std::count(used.begin(), used.end(), true)), models.dimension,
                       models.max_components);
    std::uint32_t next = 0;
    for (std::size_t k = 0; k < models.clusters(); ++k) {
        if (!used[k])
            continue;
        std::copy_n(models.mean(k), models.dimension, kept.mean(next));
        std::copy_n(models.directions.begin() +
                        static_cast<std::ptrdiff_t>(k * models.max_components * models.dimension),
                    models.max_components * models.dimension,
                    kept.directions.begin() +
                        static_cast<std::ptrdiff_t>(next * models.max_components * models.dimension));
        kept.components[next] = models.components[k];
        new_index[k] = next++;
    }
    for (std::uint32_t& k : clusters)
        k = new_index[k];
    models = std::move(kept);
}

} // namespace

CompressResult compress(const Transfer& transfer, std::span<const float> areas,
                        const CompressOptions& options, const Progress& progress) {
    check(transfer, options);
    const Stopwatch stopwatch;
    const Training training(areas);
    const PointBlocks points(transfer, training.receivers);
    std::mt19937_64 random(options.seed);
    ClusterModels models =
        vector_quantise(points, training.weights, static_cast<std::size_t>(options.clusters),
                        static_cast<std::size_t>(options.components), random, options.threads, progress);
    CompressResult result;
    std::vector<std::uint32_t> clusters;
    result.statistics.relative_l2_by_iteration =
        iterate(points, training.weights, options, models, clusters, progress);
    drop_empty(models, clusters);

    // Receivers that do not count still need some code.
    std::vector<std::uint32_t> everyone(transfer.receivers());
    std::iota(everyone.begin(), everyone.end(), 0u);
    const PointBlocks all(transfer, everyone);
    std::vector<std::uint32_t> all_clusters = assign(all, models, options.threads).clusters;
    for (std::size_t i = 0; i < clusters.size(); ++i)
        all_clusters[training.receivers[i]] = clusters[i];
    result.transfer = encode(all, models, all_clusters, transfer, options.weights);

    const ClusteredTransfer& coded = result.transfer;
    CompressStatistics& statistics = result.statistics;
    statistics.clusters = static_cast<int>(coded.bases.clusters());
    statistics.bytes_per_receiver = bytes_per_receiver(coded);
    statistics.basis_bytes = basis_bytes(coded.bases);
    statistics.seconds = stopwatch.seconds();
    progress.update(1);
    return result;
}

} // namespace prt
