#pragma once

// Nodes that draw their mesh several times: EXT_mesh_gpu_instancing.

#include "runtime/load/gltf_data.h"

namespace prt {

/// Converts every instance to a separate child node, in the JSON and the model of `data`, and adds a
/// notice. This is needed because each instance is lit differently, and transfer belongs to a node's mesh.
/// Throws `Error` with the node if its attributes are invalid.
void expand_instances(GltfData& data);

} // namespace prt
