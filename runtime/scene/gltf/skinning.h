#pragma once

#include "gltf/node_transforms.h"

#include <glm/mat4x4.hpp>
#include <tiny_gltf.h>

#include <vector>

namespace prt {

/// The matrix of each joint of a skin in the pose of `nodes` (glTF 2.0, 3.7.3).
std::vector<glm::dmat4> joint_matrices(const tinygltf::Model& model, int skin,
                                       const std::vector<NodeTransform>& nodes);

/// The matrix that takes each vertex of a skinned primitive to the world.
std::vector<glm::dmat4> skin_matrices(const tinygltf::Model& model, const std::vector<glm::dmat4>& joints,
                                      const tinygltf::Primitive& primitive, std::size_t vertices);

} // namespace prt
