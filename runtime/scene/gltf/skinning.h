#pragma once

#include "prt/animation.h"

#include <glm/mat4x4.hpp>
#include <tiny_gltf.h>

#include <span>
#include <vector>

namespace prt {

/// Throws `Error` where it, a joint or an inverse bind matrix is not there. A skin without such matrices has
/// the identity for all.
Skin read_skin(const tinygltf::Model& model, int skin);

/// The matrix of each joint in the pose of `world` [nodes] (glTF 2.0, 3.7.3), and behind them the identity.
std::vector<glm::dmat4> joint_palette(const Skin& skin, std::span<const glm::dmat4> world);

/// Reads by which of so many joints each vertex of a skinned primitive goes; vertices without weights go by
/// the identity behind them.
void read_influences(const tinygltf::Model& model, const tinygltf::Primitive& primitive, std::size_t joints,
                     std::size_t vertices, MovingVertices& moving);

} // namespace prt
