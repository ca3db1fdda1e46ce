#pragma once

#include "bake/gltf/contents.h"

namespace prt {

/// Replaces unusable float data of vertices in the document, and therefore also in files that are written
/// from it. Normals that are zero or not finite become those of the triangles of their primitives; texture
/// coordinates that are not finite become 0. Adds a notice for each kind.
void repair_vertices(GltfContents& contents);

} // namespace prt
