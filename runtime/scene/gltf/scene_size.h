#pragma once

// How much memory the meshes of a scene take, before they are read.

#include "gltf/node_transforms.h"

#include <tiny_gltf.h>

#include <cstddef>
#include <span>

namespace prt {

/// Throws `Error` when the meshes of `nodes` take more memory than a file of `file_bytes` may: every node
/// gets vertices of its own, so that a small file can ask for any number.
void check_scene_size(const tinygltf::Model& model, std::span<const NodeTransform> nodes,
                      std::size_t file_bytes);

} // namespace prt
