#pragma once

// Occlusion volumes of nodes in glTF files.

#include "prt/load/model.h"
#include "runtime/load/gltf_data.h"

#include <vector>

namespace prt {

inline constexpr int kOccluderVersion = 1;

/// Returns the occlusion volumes of the file, in ascending order of their nodes. Throws `Error` if one is
/// damaged or of another version.
std::vector<NodeOccluder> read_occluders(const GltfData& data);

} // namespace prt
