#pragma once

// Occlusion volumes in glTF files: PRTKIT_occlusion_volume of docs/format.md, an extension of the nodes that
// block light. Experimental.

#include "prt/gltf.h"
#include "prt/occlusion_volume.h"

#include <span>
#include <vector>

namespace prt {

/// An occlusion volume, and the node with which the volume moves.
struct NodeOccluder {
    int node = 0;           ///< index in the nodes of the document
    OcclusionVolume volume; ///< in the frame of the node
};

/// Removes all occlusion volumes from `document`, then writes `occluders`, which contain at most one for each
/// node. Throws `Error` if a node does not exist; `document` is then partly changed. Does not check the
/// volumes (`check_occlusion_volume`).
void write_occluders(GltfDocument& document, std::span<const NodeOccluder> occluders);

/// Returns the occlusion volumes in the file, in ascending order of their nodes; empty if the file has no
/// occlusion volumes. Throws `Error` if an occlusion volume is damaged or of another version.
std::vector<NodeOccluder> read_occluders(const GltfDocument& document);

} // namespace prt
