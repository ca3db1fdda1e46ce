#pragma once

#include "coding/weight_coding.h"

namespace prt {

/// Means and rows that fit the codes best, by least squares with the significance of the points.
void refit(const PointBlocks& points, std::span<const float> significance, const Codes& codes,
           QuantisedClusters& clusters, int threads);

} // namespace prt
