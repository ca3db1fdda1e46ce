#pragma once

// Meshes whose instances share transfer, once each in their own frame: as transfer is stored, compressed and
// written.

#include "gltf/contents.h"

namespace prt {

/// Takes the meshes that PRTKIT_instances are of away from their nodes, in the JSON and the model of
/// `contents` alike, and gives each to one new node at the root, for as long as the document is in memory.
/// Throws `Error` where a node that has the extension draws no mesh.
void set_meshes_apart(GltfContents& contents);

/// Undoes that in `json`, which is written.
void put_meshes_back(const std::vector<MeshApart>& apart, Json& json);

} // namespace prt
