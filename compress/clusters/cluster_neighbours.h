#pragma once

#include "clusters/assignment.h"

#include <Eigen/Core>

namespace prt {

/// Squared distances between the means of clusters, one against all others at once.
class MeanDistances {
public:
    explicit MeanDistances(const AffineClusters& clusters);

    /// [clusters]
    Eigen::ArrayXf from(std::size_t cluster) const;

private:
    Eigen::ArrayXXf means_; ///< [clusters] of each coordinate side by side
};

/// How far the points of a cluster lie along one of its rows.
struct RowReach {
    float inverse_norm = 1; ///< 1 over the row's squared length
    float most_weight = 1;
};

/// Clusters that are near each other, for each the `most` nearest, itself first: of four times as many whose
/// means are nearest, since further ones no row reaches, those whose points come nearest to its mean.
/// `reaches` [clusters][max_components].
ClusterLists neighbour_clusters(const AffineClusters& clusters, std::span<const RowReach> reaches,
                                std::size_t most, int threads);

} // namespace prt
