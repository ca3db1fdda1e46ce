#pragma once

// Least-squares update of clusters.

#include "compress/coding/weight_coding.h"

namespace prt {

/// Updates means and rows of `clusters` to those that fit the codes best, by least squares weighted by the
/// significance of the points.
void refit(const PointBlocks& points, std::span<const float> significance, const Codes& codes,
           QuantisedClusters& clusters, int threads);

} // namespace prt
