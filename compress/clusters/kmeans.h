#pragma once

#include "clusters/points.h"
#include "prt/support/progress.h"

#include <random>

namespace prt {

/// Vector quantisation: k-means++ seeding (Arthur and Vassilvitskii 2007), then Lloyd's iteration until the
/// squared error falls by less than 1 in 1000. `weights` [points] are positive. Returns models without
/// directions but room for `max_components`; fewer than `clusters` where there are fewer distinct points.
ClusterModels vector_quantise(const PointBlocks& points, std::span<const float> weights, std::size_t clusters,
                              std::size_t max_components, std::mt19937_64& random, int threads,
                              const Progress& progress);

} // namespace prt
