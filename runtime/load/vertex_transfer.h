#pragma once

// Compressed transfer of vertices in glTF files.

#include "prt/core/baked_transfer.h"
#include "prt/load/scene.h"
#include "runtime/load/gltf_data.h"

#include <cstddef>
#include <optional>

namespace prt {

/// Returns the component type of attributes _PRT_WEIGHTS_.
int weight_type(WeightFormat format);
/// Returns the size of one attribute _PRT_WEIGHTS_ in bytes: four floats, or one word of packed weights.
std::size_t group_bytes(WeightFormat format);
/// Returns the number of attributes _PRT_WEIGHTS_.
std::size_t group_count(const ClusteredReceivers& receivers);

/// Returns the compressed transfer of the vertices of `scene`, without the coordinates of predictors; empty
/// if the file has none. Throws `Error` if it is damaged, too large or of another version.
std::optional<CompressedTransfer> read_clustered(const GltfData& data, const Scene& scene);

} // namespace prt
