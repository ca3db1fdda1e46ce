#pragma once

// Use of images by textures.

#include "gltf/contents.h"

#include <cstddef>
#include <set>

namespace prt {

/// Returns images that are used only by textures without effect on light transfer, such as normal maps.
std::set<std::size_t> images_without_light(const Json& json);

} // namespace prt
