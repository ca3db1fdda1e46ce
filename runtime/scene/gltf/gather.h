#pragma once

#include "gltf/contents.h"

#include <cstdint>
#include <vector>

namespace prt {

/// A new accessor whose element i is element source[i] of accessor `reference`, laid out for vertex
/// attributes. Returns its index.
std::size_t gather(GltfContents& contents, const Json& reference, const std::vector<std::uint32_t>& source);

} // namespace prt
