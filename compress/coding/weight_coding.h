#pragma once

#include "coding/code_weights.h"

namespace prt {

/// What every point is coded as.
struct Codes {
    std::vector<std::uint32_t> clusters; ///< [points]
    CodeWeights weights;
    std::vector<float> errors; ///< [points] squared distance of the point to what its code stands for

    /// Of `point`, to `to` [components of its cluster].
    void read(const QuantisedClusters& of, std::size_t point, float* to) const {
        weights.read(of, clusters[point], point, to);
    }
};

/// Codes every point in its cluster. Weights are rounded one after the other, each to what the former left
/// over.
void encode_in_place(const PointBlocks& points, const QuantisedClusters& clusters, Codes& codes, int threads);

/// Codes every point in the cluster where it loses least, of the `candidates` of its present one.
void encode_points(const PointBlocks& points, const QuantisedClusters& clusters,
                   const ClusterLists& candidates, Codes& codes, int threads);

/// Clusters whose codes come nearest to each other's means.
ClusterLists neighbours_of_codes(const QuantisedClusters& clusters, std::size_t most, int threads);

/// Gives points their code of `before` back where it loses less: weights are rounded one after the other,
/// which is not always the best where rows are not orthogonal, and what refit has found for a code must not
/// be lost.
void keep_better(const PointBlocks& points, const QuantisedClusters& clusters, const Codes& before,
                 Codes& codes, int threads);

} // namespace prt
