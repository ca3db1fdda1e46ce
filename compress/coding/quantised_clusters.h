#pragma once

#include "clusters/clustering.h"
#include "coding/weight_grid.h"
#include "prt/clustered_transfer.h"

namespace prt {

/// Clusters as a file holds them: weights lie in [-1, 1] on grids, or are any. Rows need not be orthogonal.
struct QuantisedClusters : AffineClusters {
    std::vector<WeightGrid> grids; ///< [clusters][max_components]

    const WeightGrid& grid(std::size_t k, std::size_t j) const { return grids[k * max_components + j]; }
};

/// Points by their cluster, ascending.
ClusterLists members_of(std::span<const std::uint32_t> clusters, std::size_t count);

/// Rows from the principal axes of `clustering`. Packed: each as long as loses least when the weights of its
/// points are rounded to the bits of its cluster's plan. Floats: of length 1.
QuantisedClusters quantised_clusters(const PointBlocks& points, std::span<const float> significance,
                                     const Clustering& clustering, WeightFormat format, int threads);

/// Guides in units of their deviation within a cluster, on average, as weights are, so that their rows need
/// the digits of means; centers become whole numbers. Returns what the guides are to be multiplied with.
std::vector<float> scale_guides(const Clustering& clustering, QuantisedClusters& clusters);

/// Steps of rounded rows: in each cluster and group of axes `least` times a power of two.
struct RowSteps {
    double least = 0;           ///< 0: rows are not rounded
    std::vector<int> axes;      ///< [groups] axes of each, one group behind the other
    std::vector<int> exponents; ///< [clusters][groups]

    std::size_t groups() const { return axes.size(); }
    /// Steps in cluster `k`, [axes].
    std::vector<double> of(std::size_t k) const;
};

/// Rounds means and slopes to multiples of their steps and rows to multiples of twice as much.
void round_rows(AffineClusters& clusters, const RowSteps& steps);

/// Copies cluster `from` of `source` over cluster `to` of `clusters`, which has as many components and guides
/// at most; both may be the same.
void copy_cluster(const QuantisedClusters& source, std::size_t from, QuantisedClusters& clusters,
                  std::size_t to);

/// Clusters of as many components, grids and centers, all rows zero.
QuantisedClusters without_rows(const QuantisedClusters& clusters, std::size_t dimension);

/// The same clusters over the first `dimension` axes.
QuantisedClusters truncated(const QuantisedClusters& clusters, std::size_t dimension);

} // namespace prt
