#pragma once

#include "bake/gltf/contents.h"

namespace prt {

/// Adds smooth normals (smooth_vertices) to primitives of triangles without normals, in the JSON and the
/// buffer, with a notice. Returns whether there were any.
bool smooth_primitives(GltfContents& contents, double degrees);

} // namespace prt
