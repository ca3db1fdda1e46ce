#pragma once

// Reading of animations.

#include "bake/gltf/contents.h"
#include "prt/gltf/animation.h"

namespace prt {

/// Returns the translations, rotations and scales that the animations of a file apply to its nodes; other
/// targets are ignored. Throws `Error` with the animation and its channel.
std::vector<Animation> read_animations(const GltfContents& contents);

} // namespace prt
