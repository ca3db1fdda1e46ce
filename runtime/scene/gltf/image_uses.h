#pragma once

// Which textures show an image.

#include "gltf/contents.h"

#include <cstddef>
#include <set>

namespace prt {

/// Images that only textures show which transfer of light does not need, such as normal maps.
std::set<std::size_t> images_without_light(const Json& json);

} // namespace prt
