#pragma once

#include "gltf/contents.h"

namespace prt {

/// Gives primitives of triangles that have no normals smooth ones (smooth_vertices), in the JSON and the
/// buffer, with a notice. Returns whether there were any.
bool smooth_primitives(GltfContents& contents, double degrees);

} // namespace prt
