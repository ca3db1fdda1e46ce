#pragma once

// Reading of skins.

#include "prt/load/scene.h"
#include "runtime/load/gltf_model.h"

#include <glm/mat4x4.hpp>

#include <span>
#include <vector>

namespace prt {

/// Reads a skin. Throws `Error` if it, a joint or an inverse bind matrix does not exist. A skin without
/// matrices has the identity for all joints.
Skin read_skin(const GltfModel& model, int skin);

/// Returns the matrix of each joint in the pose of `world` [nodes] (glTF 2.0, 3.7.3), followed by the
/// identity.
std::vector<glm::dmat4> joint_palette(const Skin& skin, std::span<const glm::dmat4> world);

/// Reads the joints and weights of each vertex of a skinned primitive; vertices without weights use the
/// identity after the `joints` matrices.
void read_influences(const GltfModel& model, const GltfPrimitive& primitive, std::size_t joints,
                     std::size_t vertices, MovingVertices& moving);

} // namespace prt
