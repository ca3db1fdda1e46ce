#pragma once

#include "points.h"
#include "prt/clustered_transfer.h"

namespace prt {

/// Weights of every point in its cluster, stored as `format`; `shape` gives order and channels. Integers use
/// the largest weight of a cluster's direction as its scale.
ClusteredTransfer encode(const PointBlocks& points, const ClusterModels& models,
                         std::span<const std::uint32_t> clusters, const Transfer& shape, WeightFormat format);

} // namespace prt
