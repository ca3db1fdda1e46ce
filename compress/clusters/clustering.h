#pragma once

#include "clusters/cluster_rounds.h"
#include "prt/support/progress.h"
#include "tuning.h"

#include <random>

namespace prt {

/// Clusters before their weights are quantised.
struct Clustering {
    std::vector<std::uint32_t> clusters; ///< [points]
    std::vector<ClusterFit> fits;        ///< [clusters], none empty
    double cost = 0;                     ///< squared error that is expected after quantisation, with prices
    std::vector<double> history;         ///< squared error after each round, quantisation and prices left out
};

/// How long it goes on. The defaults are the compressor's; the baseline of study/ goes as published.
struct ClusteringSchedule {
    bool grow = true; ///< components come one at a time, some rounds each
    int most_rounds = tuning::kMostRounds;
    double tolerance = tuning::kRoundTolerance; ///< rounds end when the cost falls by a smaller share
    int most_move_sweeps = tuning::kMostMoveSweeps;
};

/// For an error that is to be known to a few hundredths.
inline ClusteringSchedule draft_schedule() {
    return {.tolerance = tuning::kDraftTolerance, .most_move_sweeps = tuning::kDraftMoveSweeps};
}

struct ClusteringOptions {
    std::size_t clusters = 64;
    /// [points] where to start from, numbered without gaps; empty: vector quantisation.
    std::vector<std::uint32_t> start = {};
    Spending spending;
    double mean_components = 0; ///< finds the component price that keeps to it; 0: as `spending` says
    bool rows_cost = false;     ///< finds the row price of a file whose bases count
    ClusteringSchedule schedule;
    CompressTrace trace;
    int threads = 0;
};

/// Clustered PCA (Sloan et al. 2003) from vector quantisation. Components come one at a time, which finds
/// better optima than starting with all of them; every cluster takes as many as pay under `spending`, and
/// points choose between clusters knowing what each will lose by quantisation. Then the clusters that gain
/// most by being split are, in the place of pairs that lose least by being merged, as long as the sum falls.
/// `significance` [points] sums to 1.
Clustering cluster_points(const PointBlocks& points, std::span<const float> significance,
                          const ClusteringOptions& options, std::mt19937_64& random,
                          const Progress& progress);

} // namespace prt
