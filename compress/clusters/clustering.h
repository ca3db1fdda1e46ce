#pragma once

#include "clusters/cluster_moments.h"
#include "clusters/points.h"
#include "prt/support/progress.h"

#include <random>

namespace prt {

/// Clusters before their weights are quantised.
struct Clustering {
    std::vector<std::uint32_t> clusters; ///< [points]
    std::vector<ClusterFit> fits;        ///< [clusters], none empty
    double cost = 0;                     ///< squared error that is expected after quantisation, with prices
    std::vector<double> history;         ///< squared error after each round, quantisation and prices left out
};

struct ClusteringOptions {
    std::size_t clusters = 64;
    Spending spending;
    double mean_components = 0; ///< finds the operation price that keeps to it; 0: as `spending` says
    bool rows_cost = false;     ///< finds the row price of a file whose bases count
    int most_rounds = 200;
    double tolerance = 1e-3; ///< rounds end when the cost falls by less than this share of itself
    bool grow = true;        ///< components come one at a time, two rounds each
    int most_moves = 8;      ///< sweeps of split-and-merge moves
    int threads = 0;
};

/// Clustered PCA (Sloan et al. 2003) from vector quantisation. Components come one at a time, which finds
/// better optima than starting with all of them; every cluster takes as many as pay under `spending`, and
/// points choose between clusters knowing what each will lose by quantisation. Then the clusters that gain
/// most by being split are, in the place of pairs that lose least by being merged, as long as the sum falls.
Clustering cluster_points(const PointBlocks& points, std::span<const float> weights,
                          const ClusteringOptions& options, std::mt19937_64& random,
                          const Progress& progress);

} // namespace prt
