#pragma once

#include "bake/gltf/mesh_file.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Reads a Wavefront OBJ file (Wavefront Technologies, "Object Files (.obj)", 1995): v with or without colors
/// (sRGB), vt, vn and f, with comments, continued lines and relative indices. Other lines are ignored.
/// Normals and texture coordinates are read if all corners have them. Without both, vertices are those of the
/// file; otherwise there is one for each combination that a corner has, in the order of the corners. Throws
/// `Error`.
MeshArrays read_obj(std::span<const std::byte> file);

} // namespace prt
