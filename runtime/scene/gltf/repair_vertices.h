#pragma once

#include "gltf/contents.h"

namespace prt {

/// Replaces what no reader can use in vertices of floats: normals that are not finite or zero by those of the
/// triangles of their primitives, and texture coordinates that are not finite by 0. Files that are written
/// hold the same. Adds a notice for each.
void repair_vertices(GltfContents& contents);

} // namespace prt
