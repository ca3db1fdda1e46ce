#pragma once

// Clusters with quantised weights.

#include "compress/clusters/clustering.h"
#include "compress/coding/weight_grid.h"
#include "prt/core/clustered_transfer.h"

namespace prt {

/// Clusters as in a file: weights are in [-1, 1] on grids, or unrestricted. Rows need not be orthogonal.
struct QuantisedClusters : AffineClusters {
    std::vector<WeightGrid> grids; ///< [clusters][max_components]

    const WeightGrid& grid(std::size_t k, std::size_t j) const { return grids[k * max_components + j]; }
};

/// Returns the points of each cluster, ascending.
ClusterLists members_of(std::span<const std::uint32_t> clusters, std::size_t count);

/// Returns rows from the principal axes of `clustering`. Packed: with the length of minimum loss when the
/// weights of the points are rounded to the bits of the cluster's plan. Floats: of length 1.
QuantisedClusters quantised_clusters(const PointBlocks& points, std::span<const float> significance,
                                     const Clustering& clustering, WeightFormat format, int threads);

/// Scales predictors to units of their mean deviation within a cluster, like weights, so that their rows need
/// the same precision as means; centers become integers. Returns the factors for the predictors.
std::vector<float> scale_predictors(const Clustering& clustering, QuantisedClusters& clusters);

/// Steps of rounded rows: in each cluster and group of axes, `least` times a power of two.
struct RowSteps {
    double least = 0;           ///< 0: rows are not rounded
    std::vector<int> axes;      ///< [groups] number of axes per group; groups are consecutive
    std::vector<int> exponents; ///< [clusters][groups]

    std::size_t groups() const { return axes.size(); }
    /// Returns the steps in cluster `k`, [axes].
    std::vector<double> of(std::size_t k) const;
};

/// Rounds means and slopes to multiples of their steps, and rows to multiples of twice the step.
void round_rows(AffineClusters& clusters, const RowSteps& steps);

/// Copies cluster `from` of `source` over cluster `to` of `clusters`, which has the same or a larger maximum
/// number of components and predictors; both may be the same object.
void copy_cluster(const QuantisedClusters& source, std::size_t from, QuantisedClusters& clusters,
                  std::size_t to);

/// Returns clusters with the same components, grids and centers, and all rows zero.
QuantisedClusters without_rows(const QuantisedClusters& clusters, std::size_t dimension);

/// Returns the clusters restricted to the first `dimension` axes.
QuantisedClusters truncated(const QuantisedClusters& clusters, std::size_t dimension);

} // namespace prt
