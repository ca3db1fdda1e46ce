#pragma once

// Occlusion volumes in glTF files: PRTKIT_occlusion_volume of docs/format.md, an extension of the nodes that
// block light. Experimental.

#include "prt/gltf.h"
#include "prt/occlusion_volume.h"

#include <span>
#include <vector>

namespace prt {

struct NodeOccluder {
    int node = 0;           ///< index in the file
    OcclusionVolume volume; ///< in the frame of the node
};

/// Writes occlusion volumes and replaces existing ones.
void write_occluders(GltfDocument& document, std::span<const NodeOccluder> occluders);

/// Returns the occlusion volumes in the order of nodes; empty if absent. Throws `Error` if they are
/// damaged.
std::vector<NodeOccluder> read_occluders(const GltfDocument& document);

} // namespace prt
