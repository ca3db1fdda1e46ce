#pragma once

// Reads raw transfer whose vectors are in one view: of texels and of probes.

#include "prt/core/baked_transfer.h"
#include "runtime/load/gltf_data.h"

#include <cstddef>

namespace prt {

/// Reads layout, record and vectors of `set` for `receivers` receivers. Throws `Error` if they are damaged or
/// too large.
BakedTransfer read_raw_set(const GltfData& data, const Json& set, std::size_t receivers);

} // namespace prt
