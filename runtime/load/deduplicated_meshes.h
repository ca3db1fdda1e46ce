#pragma once

// Meshes whose instances share transfer, once each in their own frame: the form in which transfer is stored,
// compressed and written.

#include "runtime/load/gltf_data.h"

namespace prt {

/// Moves the meshes with PRTKIT_instances from their nodes to one new root node each, in the JSON and the
/// model of `data`, while the document is in memory. Throws `Error` if a node with the extension has no
/// mesh.
void deduplicate_meshes(GltfData& data);

/// Undoes `deduplicate_meshes` in `json`, for writing.
void put_meshes_back(const std::vector<DeduplicatedMesh>& separate, Json& json);

} // namespace prt
