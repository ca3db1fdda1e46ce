// A round of clustered PCA (Sloan, Hall, Hart and Snyder 2003, "Clustered Principal Components for
// Precomputed Radiance Transfer"): Lloyd's iteration with affine subspaces and penalties for the expected
// quantisation loss, as in entropy-constrained vector quantisation (Chou, Lookabaugh and Gray 1989).

#include "compress/clusters/cluster_rounds.h"

#include "compress/clusters/cluster_neighbours.h"
#include "compress/tuning/tuning.h"

#include <cmath>

namespace prt {
namespace {

/// Returns the extent of weights along each direction: a few standard deviations.
std::vector<RowReach> reaches_of(const std::vector<ClusterFit>& fits, std::size_t max_components) {
    std::vector<RowReach> reaches(fits.size() * max_components);
    for (std::size_t k = 0; k < fits.size(); ++k)
        for (std::size_t j = 0; j < fits[k].plan.bits.size(); ++j)
            reaches[k * max_components + j].max_weight =
                tuning::kReach * static_cast<float>(std::sqrt(fits[k].variances[j]));
    return reaches;
}

} // namespace

PenalisedClusters penalised_clusters(const std::vector<ClusterFit>& fits, std::size_t dimension) {
    std::size_t most = 0;
    for (const ClusterFit& fit : fits)
        most = std::max(most, fit.plan.bits.size());
    const std::size_t predictors = fits.empty() ? 0 : fits.front().center.size();
    PenalisedClusters result(fits.size(), dimension, most, predictors);
    for (std::size_t k = 0; k < fits.size(); ++k) {
        const ClusterFit& fit = fits[k];
        std::copy(fit.mean.begin(), fit.mean.end(), result.mean(k));
        std::copy(fit.center.begin(), fit.center.end(), result.center(k));
        std::copy(fit.slopes.begin(), fit.slopes.end(), result.slope(k, 0));
        if (!fit.directions.empty())
            std::copy(fit.directions.begin(), fit.directions.end(), result.row(k, 0));
        result.components[k] = static_cast<int>(fit.plan.bits.size());
        // Penalty of a point in addition to its distance. The plan's error includes the variance along
        // dropped axes, which the distance counts exactly.
        result.penalties[k] = fit.significance > 0 ? static_cast<float>(fit.plan.penalty)
                                                   : std::numeric_limits<float>::infinity();
    }
    return result;
}

ClusterState ClusterRounds::start(const PenalisedClusters& centers) const {
    return start(assign(points, centers, threads).clusters, centers.clusters());
}

ClusterState ClusterRounds::start(std::vector<std::uint32_t> clusters, std::size_t count) const {
    ClusterState state{std::move(clusters), ClusterMoments(count, points.dimension, points.predictors),
                       std::vector<ClusterFit>(count), 0};
    state.moments.build(points, significance, state.clusters, threads);
    return state;
}

void ClusterRounds::refit(ClusterState& state, const RateBudget& rate_budget) const {
    parallel_for(state.fits.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
            state.fits[k] = fit_cluster(state.moments.view(k), rate_budget);
    });
    state.cost = 0;
    for (const ClusterFit& fit : state.fits)
        state.cost += fit.cost(rate_budget);
}

void ClusterRounds::reassign(ClusterState& state) const {
    const PenalisedClusters clusters = penalised_clusters(state.fits, points.dimension);
    std::vector<std::uint32_t> next =
        state.fits.size() <= 2 * tuning::kNeighbours
            ? assign(points, clusters, threads).clusters
            : prt::reassign(points, clusters,
                            neighbour_clusters(clusters, reaches_of(state.fits, clusters.max_components),
                                               tuning::kNeighbours, threads),
                            state.clusters, threads);
    state.moments.update(points, significance, state.clusters, next, threads);
    state.clusters = std::move(next);
}

} // namespace prt
