#pragma once

// Clustered PCA of points.

#include "compress/clusters/cluster_rounds.h"
#include "compress/tuning/tuning.h"
#include "prt/core/progress.h"

#include <random>

namespace prt {

/// Clusters before their weights are quantised.
struct Clustering {
    std::vector<std::uint32_t> clusters; ///< [points]
    std::vector<ClusterFit> fits;        ///< [clusters], without empty clusters
    double cost = 0;                     ///< expected squared error after quantisation, including multipliers
    std::vector<double> history; ///< squared error after each round, without quantisation and multipliers
};

/// Duration of the clustering. The defaults are those of the compressor; the baseline of study/ uses the
/// published schedule.
struct ClusteringSchedule {
    bool grow = true; ///< components are added one at a time, with some rounds each
    int max_rounds = tuning::kMaxRounds;
    double tolerance = tuning::kRoundTolerance; ///< rounds end when the cost decreases by a smaller fraction
    int max_move_sweeps = tuning::kMaxMoveSweeps;
};

/// Returns the schedule for an error that is known to a few hundredths.
inline ClusteringSchedule draft_schedule() {
    return {.tolerance = tuning::kDraftTolerance, .max_move_sweeps = tuning::kDraftMoveSweeps};
}

struct ClusteringOptions {
    std::size_t clusters = 64;
    /// [points] start clusters, numbered without gaps; empty: vector quantisation.
    std::vector<std::uint32_t> start = {};
    RateBudget rate_budget;
    double mean_components = 0; ///< finds the component multiplier for this mean; 0: uses `rate_budget`
    bool rows_cost = false;     ///< finds the row multiplier for a file whose bases count
    ClusteringSchedule schedule;
    CompressTrace trace;
    int threads = 0;
};

/// Computes clustered PCA (Sloan et al. 2003), starting from vector quantisation. Components are added one at
/// a time, which finds better optima than starting with all. Every cluster uses the most economical number
/// under `rate_budget`, and points choose clusters with their expected quantisation loss. Finally, clusters
/// with the largest gain are split and pairs with the smallest loss are merged in exchange, while the total
/// cost decreases. `significance` [points] sums to 1.
Clustering cluster_points(const PointBlocks& points, std::span<const float> significance,
                          const ClusteringOptions& options, std::mt19937_64& random,
                          const Progress& progress);

} // namespace prt
