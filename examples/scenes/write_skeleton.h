#pragma once

#include "skeleton.h"

#include <tiny_gltf.h>

namespace examples {

/// Gives a primitive the joints and weights of its vertices, where they have any.
void add_skin_attributes(tinygltf::Model& model, tinygltf::Primitive& primitive, const SkinWeights& skin);

/// Adds the joints of a skeleton as nodes, the skin of node `skinned`, and its movements as animations, whose
/// `extras` tell the speed in metres per second. Of a skeleton without joints nothing.
void add_skeleton(tinygltf::Model& model, const Skeleton& skeleton, int skinned);

} // namespace examples
