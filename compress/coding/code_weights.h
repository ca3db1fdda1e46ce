#pragma once

// Bit-packed storage of weights.

#include "compress/coding/quantised_clusters.h"

#include <cstddef>
#include <vector>

namespace prt {

/// The weights of all points, each with the bit width of its cluster's grid: as compact as in the file,
/// because the compressor holds several versions at once. Floats for unrestricted grids.
class CodeWeights {
public:
    CodeWeights() = default;
    /// Sets all weights to the minimum value.
    CodeWeights(std::size_t points, const QuantisedClusters& clusters);

    /// Reads the weights of a point in cluster `k`: one per component of the cluster.
    void read(const QuantisedClusters& clusters, std::size_t k, std::size_t point, float* weights) const;
    /// Writes the weights of a point. Threads may write different points at once.
    void write(const QuantisedClusters& clusters, std::size_t k, std::size_t point, const float* weights);
    /// Copies a code of `other`, whose clusters must have the same grids.
    void copy(const CodeWeights& other, std::size_t point);

private:
    std::size_t stride_ = 0; ///< bytes per point
    std::vector<std::byte> bytes_;
};

} // namespace prt
