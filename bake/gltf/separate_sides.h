#pragma once

// Splits double-sided surfaces into two single-sided ones, so that each side has separate vertices.
// Experimental.

#include "prt/gltf/gltf.h"
#include "prt/load/scene.h"

#include <vector>

namespace prt {

/// Returns `document` with a second triangle of opposite winding for each triangle that is true in
/// `triangles`, [triangles of `scene`, primitive by primitive]. The vertices of the second triangle are
/// copies with negated normals and tangents. The material of both triangles becomes single-sided; if other
/// triangles use it also, both triangles get a copy. Triangles are ignored if their primitive is
/// single-sided, by its material or by a material of KHR_materials_variants. Entries of primitives without a
/// material must be false. `scene` must be extracted from `document`. Each node gets a separate copy of a
/// shared mesh, primitives without normals get flat normals, and transfer is removed. Throws `Error`, with
/// the file name, if `document` is damaged or becomes too large.
GltfDocument with_separate_sides(GltfDocument document, const Scene& scene,
                                 const std::vector<bool>& triangles);

} // namespace prt
