#pragma once

// Writes clusters, bases and packed weights into the extensions of prtkit.

#include "bake/gltf/write_transfer_json.h"
#include "prt/core/clustered_transfer.h"
#include "runtime/load/clustered_json.h"

namespace prt {

Json write_bases(GltfContents& contents, const ClusteredBases& bases);
Json write_packing(GltfContents& contents, const ClusteredTransfer& transfer);

} // namespace prt
