#pragma once

// Memory estimate of a scene's meshes before they are read.

#include "runtime/load/gltf_data.h"
#include "runtime/load/node_transforms.h"

#include <span>

namespace prt {

/// Throws `Error` if the meshes of `nodes` need more memory than the file, or its reader, allows: every node
/// gets separate vertices, so that a small file could require any amount.
void check_scene_size(const GltfData& data, std::span<const NodeTransform> nodes);

} // namespace prt
