#pragma once

#include "gltf/contents.h"

#include <cstdint>
#include <vector>

namespace prt {

/// Adds an accessor whose element i is element source[i] of accessor `reference`, laid out for vertex
/// attributes. Returns its index.
std::size_t add_gathered_accessor(GltfContents& contents, const Json& reference,
                                  const std::vector<std::uint32_t>& source);

} // namespace prt
