#pragma once

#include "coding/quantised_clusters.h"

#include <cstddef>
#include <vector>

namespace prt {

/// The weights of all points, each in as many bits as the grid of its cluster has: as small as in the file,
/// of which the compressor holds several versions side by side. Floats where a grid is any.
class CodeWeights {
public:
    CodeWeights() = default;
    /// All of the least value.
    CodeWeights(std::size_t points, const QuantisedClusters& clusters);

    /// The weights of a point that is in cluster `k`: as many of `weights` as it has components.
    void read(const QuantisedClusters& clusters, std::size_t k, std::size_t point, float* weights) const;
    /// Threads may write different points at once.
    void write(const QuantisedClusters& clusters, std::size_t k, std::size_t point, const float* weights);
    /// A code of `other`, whose clusters have the same grids.
    void copy(const CodeWeights& other, std::size_t point);

private:
    std::size_t stride_ = 0; ///< bytes of a point
    std::vector<std::byte> bytes_;
};

} // namespace prt
