#pragma once

// Sets of receivers with clustered transfer: bases, predictors and packed weights.

#include "prt/core/baked_transfer.h"
#include "prt/load/scene.h"
#include "runtime/load/gltf_data.h"

#include <cstddef>

namespace prt {

/// Reads order, terms, components and bit widths of weights of a set, without its bases; computes the number
/// of words per receiver. Without packing, ClusteredReceivers::words is 0. Throws `Error` if they are
/// invalid.
ClusteredTransfer read_clusters(const GltfData& data, const Json& set, std::size_t outputs = 1);

/// Reads the clusters, predictors, bases and the record of a set, without clusters and weights of receivers.
/// Throws `Error` if they are damaged.
CompressedTransfer read_clustered_set(const GltfData& data, const Scene& scene, const Json& set,
                                      std::size_t outputs = 1);

} // namespace prt
