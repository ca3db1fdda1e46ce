#pragma once

#include "gltf/contents.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Adds an accessor that is like `accessor`, but for its elements: those, tightly packed, laid out for vertex
/// attributes. Returns its index.
std::size_t add_vertex_accessor(GltfContents& contents, Json accessor, std::span<const std::byte> elements);

/// Adds an accessor whose element i is element source[i] of accessor `reference`, laid out for vertex
/// attributes. Returns its index.
std::size_t add_gathered_accessor(GltfContents& contents, const Json& reference,
                                  const std::vector<std::uint32_t>& source);

/// Adds an accessor for the indices of a primitive. Returns its index.
std::size_t add_index_accessor(GltfContents& contents, std::span<const std::uint32_t> indices);

} // namespace prt
