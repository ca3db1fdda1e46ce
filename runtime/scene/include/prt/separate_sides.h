#pragma once

// Double-sided surfaces as two single-sided ones, so that each side has vertices of its own. Experimental.

#include "prt/gltf.h"
#include "prt/scene.h"

#include <vector>

namespace prt {

/// The file with a second, opposite triangle at each of `triangles` [triangles of the scene]: its vertices
/// are copies with normals and tangents turned round, and both have copies of their material that are
/// single-sided, in variants, too. A primitive that is single-sided in some variant stays as it is. `scene`
/// is extracted from `document`, whose meshes get a copy for each node, whose primitives without normals get
/// flat ones, and whose transfer is taken out. Throws `Error`.
GltfDocument with_separate_sides(GltfDocument document, const Scene& scene,
                                 const std::vector<bool>& triangles);

} // namespace prt
