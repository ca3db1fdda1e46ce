#pragma once

// Clusters, bases and packed weights in the extensions of prtkit.

#include "prt/core/clustered_transfer.h"
#include "runtime/load/transfer_json.h"

namespace prt {

inline constexpr int kClusteredVersion = 8;

/// Reads order, terms and components of an extension. Throws `Error` if they are invalid.
ClusteredBases read_clusters_of(const Json& extension, std::size_t outputs = 1);

/// Reads the rows of `bases`, whose components are known. Throws `Error` if they are damaged.
void read_bases(const GltfData& data, const Json& json, ClusteredBases& bases);

/// Reads the bit widths of weights, and computes the number of words per receiver. Throws `Error`.
void read_packing(const GltfData& data, const Json& json, ClusteredTransfer& transfer);

} // namespace prt
