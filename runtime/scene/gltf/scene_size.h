#pragma once

// How much memory the meshes of a scene take, before they are read.

#include "gltf/contents.h"
#include "gltf/node_transforms.h"

#include <span>

namespace prt {

/// Throws `Error` when the meshes of `nodes` take more memory than the file, or its reader, allows: every
/// node gets vertices of its own, so that a small file can ask for any number.
void check_scene_size(const GltfContents& contents, std::span<const NodeTransform> nodes);

} // namespace prt
