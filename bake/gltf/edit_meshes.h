#pragma once

// Frames of functions that rewrite the meshes of a document.

#include "bake/gltf/contents.h"
#include "bake/gltf/make_meshes_unique.h"
#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"
#include "prt/load/scene.h"

#include <functional>

namespace prt {

/// Calls `meshes_without_transfer`, then `edit`, and reads the result again. `scene` must be extracted from
/// `document`; its VertexArray::lobes can differ.
GltfDocument edit_meshes(GltfDocument document, const Scene& scene,
                         const std::function<void(GltfContents&)>& edit,
                         ChangedMeshes changed = ChangedMeshes::all);

/// Like `edit_meshes` for a result of `with_shared_meshes` without factors, in which shared meshes remain one
/// mesh. `stored` must be extracted from `shared.document`. The result has the form of `Instancing::nodes`.
GltfDocument edit_shared_meshes(SharedDocument shared, const Scene& stored,
                                const std::function<void(GltfContents&)>& edit);

} // namespace prt
