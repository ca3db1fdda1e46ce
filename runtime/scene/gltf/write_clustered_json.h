#pragma once

// Writes clusters, bases and packed weights into the extensions of prtkit.

#include "prt/core/clustered_transfer.h"
#include "runtime/load/clustered_json.h"
#include "runtime/scene/gltf/write_transfer_json.h"

namespace prt {

Json write_bases(GltfContents& contents, const ClusteredBases& bases);
Json write_packing(GltfContents& contents, const ClusteredTransfer& transfer);

} // namespace prt
