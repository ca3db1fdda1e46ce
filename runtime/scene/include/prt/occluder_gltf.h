#pragma once

// Occlusion volumes in glTF files: PRTKIT_occlusion_volume of docs/format.md, an extension of the nodes that
// carry what blocks. Experimental.

#include "prt/gltf.h"
#include "prt/occlusion_volume.h"

#include <span>
#include <vector>

namespace prt {

struct NodeOccluder {
    int node = 0;           ///< of the file
    OcclusionVolume volume; ///< in the frame of the node
};

/// Writes them in the place of any that are there.
void write_occluders(GltfDocument& document, std::span<const NodeOccluder> occluders);

/// In the order of nodes; none where the file holds none. Throws `Error` when they are damaged.
std::vector<NodeOccluder> read_occluders(const GltfDocument& document);

} // namespace prt
