#pragma once

// Reading of animations.

#include "prt/animation.h"

#include <tiny_gltf.h>

namespace prt {

/// Returns the translations, rotations and scales that the animations of a file apply to its nodes; other
/// targets are ignored. Throws `Error` with the animation and its channel.
std::vector<Animation> read_animations(const tinygltf::Model& model);

} // namespace prt
