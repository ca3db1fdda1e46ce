#pragma once

// Rounds of clustered PCA.

#include "compress/clusters/assignment.h"
#include "compress/clusters/cluster_moments.h"
#include "prt/compress/compress_trace.h"

namespace prt {

/// State that a round changes.
struct ClusterState {
    std::vector<std::uint32_t> clusters; ///< [points]
    ClusterMoments moments;
    std::vector<ClusterFit> fits;
    double cost = 0; ///< cost of the fits, including multipliers
};

/// Rounds of clustered PCA. Keeps references.
struct ClusterRounds {
    const PointBlocks& points;
    std::span<const float> significance; ///< [points]
    const CompressTrace& trace;
    int threads;

    /// Assigns every point to the nearest cluster; nothing is fitted yet.
    ClusterState start(const PenalisedClusters& centers) const;
    /// Starts from known clusters, numbered below `count`; nothing is fitted yet.
    ClusterState start(std::vector<std::uint32_t> clusters, std::size_t count) const;
    /// Computes local PCA of every cluster, with the most economical number of components. Empty clusters
    /// stay empty.
    void refit(ClusterState& state, const RateBudget& rate_budget) const;
    /// Assigns every point to the best cluster.
    void reassign(ClusterState& state) const;
    void round(ClusterState& state, const RateBudget& rate_budget) const {
        refit(state, rate_budget);
        reassign(state);
    }
    void tell(const CompressEvent& event) const {
        if (trace)
            trace(event);
    }
};

/// Converts fits to clusters for the assignment of points.
PenalisedClusters penalised_clusters(const std::vector<ClusterFit>& fits, std::size_t dimension);

} // namespace prt
