#pragma once

// Splits double-sided surfaces into two single-sided ones, so that each side has separate vertices.
// Experimental.

#include "prt/gltf.h"
#include "prt/scene.h"

#include <vector>

namespace prt {

/// Returns the file with a second, opposite triangle for each triangle that is marked in `triangles`
/// [triangles of the scene]. The vertices of the second triangle are copies with negated normals and
/// tangents. Both triangles get single-sided copies of their material, also in variants. A primitive that is
/// single-sided in any variant is not changed. `scene` must be extracted from `document`. Meshes are copied
/// for each node, primitives without normals get flat ones, and transfer is removed. Throws `Error`.
GltfDocument with_separate_sides(GltfDocument document, const Scene& scene,
                                 const std::vector<bool>& triangles);

} // namespace prt
