#pragma once

// Vector quantisation.

#include "compress/clusters/assignment.h"
#include "prt/core/progress.h"

#include <random>

namespace prt {

/// Computes vector quantisation: k-means++ seeding, then Lloyd's iteration. `significance` [points] sums to
/// 1. Returns clusters without rows; fewer than `clusters` if there are fewer distinct points.
PenalisedClusters vector_quantise(const PointBlocks& points, std::span<const float> significance,
                                  std::size_t clusters, std::mt19937_64& random, int threads,
                                  const Progress& progress);

} // namespace prt
