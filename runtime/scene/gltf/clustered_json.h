#pragma once

// Clusters, bases and packed weights as the extensions of prtkit hold them.

#include "gltf/transfer_json.h"
#include "prt/clustered_transfer.h"

namespace prt {

inline constexpr int kClusteredVersion = 7;

/// Order, parts and components of an extension. Throws `Error` where they make no sense.
ClusteredBases read_clusters_of(const Json& extension, std::size_t outputs = 1);

Json write_bases(GltfContents& contents, const ClusteredBases& bases);
/// Reads the rows of `bases`, whose components are known. Throws `Error` where they are damaged.
void read_bases(const GltfContents& contents, const Json& json, ClusteredBases& bases);

Json write_packing(GltfContents& contents, const ClusteredTransfer& transfer);
/// Reads the bits of weights, and by that how many words a receiver has. Throws `Error`.
void read_packing(const GltfContents& contents, const Json& json, ClusteredTransfer& transfer);

} // namespace prt
