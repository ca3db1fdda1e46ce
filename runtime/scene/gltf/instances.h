#pragma once

// Nodes that draw their mesh many times: EXT_mesh_gpu_instancing.

#include "gltf/contents.h"

namespace prt {

/// Gives every instance a node of its own below the one that has them, in the JSON and the model of
/// `contents` alike, with a notice: each is lit differently, and transfer belongs to a node's mesh. Throws
/// `Error` that names the node where its attributes do not fit.
void expand_instances(GltfContents& contents);

} // namespace prt
