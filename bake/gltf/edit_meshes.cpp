// Rewrites the meshes of a document.
#include "bake/gltf/edit_meshes.h"

#include "bake/gltf/reparse.h"
#include "bake/gltf/write_set.h"

#include <utility>

namespace prt {

GltfDocument edit_meshes(GltfDocument document, const Scene& scene,
                         const std::function<void(GltfContents&)>& edit, ChangedMeshes changed) {
    named(document, [&](GltfContents& contents) { meshes_without_transfer(contents, scene, changed); });
    document = reparse(document);
    named(document, edit);
    return reparse(document);
}

GltfDocument edit_shared_meshes(SharedDocument shared, const Scene& stored,
                                const std::function<void(GltfContents&)>& edit) {
    named(shared.document, [&](GltfContents& contents) { make_meshes_unique(contents, stored); });
    GltfDocument document = reparse(shared.document, Instancing::separate);
    named(document, edit);
    document = reparse(document);
    named(document, [](GltfContents& contents) { contents.remove_transfer(); });
    return document;
}

} // namespace prt
