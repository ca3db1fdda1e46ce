#pragma once

// Neighbourhoods of clusters.

#include "compress/clusters/assignment.h"

#include <Eigen/Core>

namespace prt {

/// Squared distances between the means of clusters, of one to all others at once.
class MeanDistances {
public:
    explicit MeanDistances(const AffineClusters& clusters);

    /// Returns the squared distances from one cluster to all, [clusters].
    Eigen::ArrayXf from(std::size_t cluster) const;

private:
    Eigen::ArrayXXf means_; ///< [clusters], coordinate by coordinate
};

/// Extent of the points of a cluster along one of its rows.
struct RowReach {
    float inverse_norm = 1; ///< 1 over the row's squared length
    float max_weight = 1;
};

/// Returns for each cluster the `most` nearest, itself first. Among four times that number of clusters with
/// the nearest means (no row reaches farther ones), it selects those whose points come nearest to its mean.
/// `reaches` is [clusters][max_components].
ClusterLists neighbour_clusters(const AffineClusters& clusters, std::span<const RowReach> reaches,
                                std::size_t most, int threads);

} // namespace prt
