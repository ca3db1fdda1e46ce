#pragma once

// Splits double-sided surfaces into two single-sided ones, so that each side has separate vertices.
// Experimental.

#include "bake/gltf/make_meshes_unique.h"
#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"
#include "prt/load/scene.h"

#include <vector>

namespace prt {

/// Returns `document` with a second triangle of opposite winding for each triangle that is true in
/// `triangles`, [triangles of `scene`, primitive by primitive]. The vertices of the second triangle are
/// copies with negated normals and tangents. The material of both triangles becomes single-sided; if other
/// triangles use it also, both triangles get a copy. Triangles are ignored if their primitive is
/// single-sided, by its material or by a material of KHR_materials_variants. Entries of primitives without a
/// material must be false. `scene` must be extracted from `document`. Each `changed` node gets a separate
/// copy of a shared mesh, its primitives without normals get flat normals, and its transfer is removed;
/// `triangles` must be false elsewhere. Throws `Error`, with the file name, if `document` is damaged or
/// becomes too large.
GltfDocument with_separate_sides(GltfDocument document, const Scene& scene,
                                 const std::vector<bool>& triangles,
                                 ChangedMeshes changed = ChangedMeshes::all);

/// Returns `shared.document`, a result of `with_shared_meshes` without factors, with separate sides in the
/// form of `Instancing::nodes`: instances of a shared mesh draw one mesh, and share the new vertices.
/// `stored` must be extracted from `shared.document`; `triangles` are [triangles of `stored`]. Otherwise like
/// `with_separate_sides`.
GltfDocument with_separate_sides_of_meshes(SharedDocument shared, const Scene& stored,
                                           const std::vector<bool>& triangles);

} // namespace prt
