#pragma once

#include "clusters/assignment.h"
#include "clusters/cluster_moments.h"
#include "prt/compress_trace.h"

namespace prt {

/// Everything that a round changes.
struct ClusterState {
    std::vector<std::uint32_t> clusters; ///< [points]
    ClusterMoments moments;
    std::vector<ClusterFit> fits;
    double cost = 0; ///< of the fits, prices included
};

/// Rounds of clustered PCA. Keeps references.
struct ClusterRounds {
    const PointBlocks& points;
    std::span<const float> significance; ///< [points]
    const CompressTrace& trace;
    int threads;

    /// Every point in the cluster that is nearest; nothing is fitted yet.
    ClusterState start(const PenalisedClusters& centers) const;
    /// Points in clusters that are known, numbered below `count`; nothing is fitted yet.
    ClusterState start(std::vector<std::uint32_t> clusters, std::size_t count) const;
    /// Local PCA of every cluster, with as many components as pay. Empty clusters stay empty.
    void refit(ClusterState& state, const Spending& spending) const;
    /// Gives every point the best cluster.
    void reassign(ClusterState& state) const;
    void round(ClusterState& state, const Spending& spending) const {
        refit(state, spending);
        reassign(state);
    }
    void tell(const CompressEvent& event) const {
        if (trace)
            trace(event);
    }
};

/// The fits as points choose between them.
PenalisedClusters penalised_clusters(const std::vector<ClusterFit>& fits, std::size_t dimension);

} // namespace prt
