#pragma once

#include "skeleton.h"

#include <tiny_gltf.h>

namespace examples {

/// Adds joints and weights to a primitive, if its vertices have any.
void add_skin_attributes(tinygltf::Model& model, tinygltf::Primitive& primitive, const SkinWeights& skin);

/// Adds the joints of a skeleton as nodes, the skin of node `skinned`, and its movements as animations, whose
/// `extras` contain the speed in metres per second. Does nothing for a skeleton without joints.
void add_skeleton(tinygltf::Model& model, const Skeleton& skeleton, int skinned);

} // namespace examples
