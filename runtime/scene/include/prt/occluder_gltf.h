#pragma once

// Occlusion volumes in glTF files: PRTKIT_occlusion_volume of docs/format.md, an extension of the nodes that
// block light. Experimental.

#include "prt/gltf.h"
#include "prt/occlusion_volume.h"

#include <span>
#include <vector>

namespace prt {

/// An occlusion volume and the node that it moves with.
struct NodeOccluder {
    int node = 0;           ///< index in the file
    OcclusionVolume volume; ///< in the frame of the node
};

/// Writes occlusion volumes into `document` and removes existing ones.
void write_occluders(GltfDocument& document, std::span<const NodeOccluder> occluders);

/// Returns the occlusion volumes in the file, in the order of their nodes; empty if absent. Throws `Error` if
/// they are damaged.
std::vector<NodeOccluder> read_occluders(const GltfDocument& document);

} // namespace prt
