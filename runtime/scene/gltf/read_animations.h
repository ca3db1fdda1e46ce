#pragma once

#include "gltf/contents.h"
#include "prt/animation.h"

namespace prt {

/// Translations, rotations and scales that the animations of a file give its nodes; what else they move
/// stays. Throws `Error` that names the animation and its channel.
std::vector<Animation> read_animations(const GltfContents& contents);

} // namespace prt
