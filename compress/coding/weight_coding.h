#pragma once

// Coding of points by clusters and quantised weights.

#include "compress/coding/code_weights.h"

namespace prt {

/// Codes of all points.
struct Codes {
    std::vector<std::uint32_t> clusters; ///< [points]
    CodeWeights weights;
    std::vector<float> errors; ///< [points] squared distance from the point to its decoded value

    /// Reads the weights of `point` to `to` [components of its cluster].
    void read(const QuantisedClusters& of, std::size_t point, float* to) const {
        weights.read(of, clusters[point], point, to);
    }
};

/// Codes every point in its cluster. Weights are rounded one after another, each for the residual of the
/// previous ones.
void encode_in_place(const PointBlocks& points, const QuantisedClusters& clusters, Codes& codes, int threads);

/// Codes every point in the cluster of minimum loss among the `candidates` of its current one.
void encode_points(const PointBlocks& points, const QuantisedClusters& clusters,
                   const ClusterLists& candidates, Codes& codes, int threads);

/// Returns the clusters whose codes come nearest to each other's means.
ClusterLists neighbours_of_codes(const QuantisedClusters& clusters, std::size_t most, int threads);

/// Restores a point's code of `before` if its loss is smaller. Sequential rounding of weights is not always
/// optimal for non-orthogonal rows, and the improvement by refit must not be lost.
void keep_better(const PointBlocks& points, const QuantisedClusters& clusters, const Codes& before,
                 Codes& codes, int threads);

} // namespace prt
