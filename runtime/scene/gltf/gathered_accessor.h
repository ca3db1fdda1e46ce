#pragma once

#include "gltf/contents.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

namespace prt {

/// Adds an accessor that is like `accessor`, but for its elements: those, tightly packed, laid out for vertex
/// attributes. Returns its index.
std::size_t add_vertex_accessor(GltfContents& contents, Json accessor, std::span<const std::byte> elements);

/// Elements source[i] of an accessor, tightly packed.
std::vector<std::byte> gathered_elements(const tinygltf::Model& model, int accessor,
                                         const std::vector<std::uint32_t>& source);

/// Adds an accessor whose element i is element source[i] of accessor `reference`, laid out for vertex
/// attributes. Returns its index.
std::size_t add_gathered_accessor(GltfContents& contents, const Json& reference,
                                  const std::vector<std::uint32_t>& source);

/// Adds an accessor for the indices of a primitive. Returns its index.
std::size_t add_index_accessor(GltfContents& contents, std::span<const std::uint32_t> indices);

/// Gives `primitive` these triangles, corners of a mirrored one the other way round; `replaced` gets the
/// accessor that it had.
void replace_triangles(GltfContents& contents, Json& primitive, std::span<const glm::uvec3> triangles,
                       bool mirrored, std::set<std::size_t>& replaced);

} // namespace prt
