#pragma once

// Memory estimate of a scene's meshes before they are read.

#include "gltf/node_transforms.h"

#include <tiny_gltf.h>

#include <cstddef>
#include <span>

namespace prt {

/// Throws `Error` if the meshes of `nodes` need more memory than a file of `file_bytes` may use: every node
/// gets separate vertices, so that a small file could require any amount.
void check_scene_size(const tinygltf::Model& model, std::span<const NodeTransform> nodes,
                      std::size_t file_bytes);

} // namespace prt
