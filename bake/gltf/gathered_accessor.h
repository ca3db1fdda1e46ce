#pragma once

// Accessors with reordered elements.

#include "bake/gltf/contents.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

namespace prt {

/// Adds an accessor with the properties of `accessor` and the given tightly packed elements, laid out for
/// vertex attributes. Returns its index.
std::size_t add_vertex_accessor(GltfContents& contents, Json accessor, std::span<const std::byte> elements);

/// Returns the elements source[i] of an accessor, tightly packed.
std::vector<std::byte> gathered_elements(const GltfModel& model, int accessor,
                                         const std::vector<std::uint32_t>& source);

/// Adds an accessor whose element i is element source[i] of accessor `reference`, laid out for vertex
/// attributes. Returns its index.
std::size_t add_gathered_accessor(GltfContents& contents, const Json& reference,
                                  const std::vector<std::uint32_t>& source);

/// Adds an accessor for the indices of a primitive. Returns its index.
std::size_t add_index_accessor(GltfContents& contents, std::span<const std::uint32_t> indices);

/// Sets the triangles of `primitive`; reverses the winding order if `mirrored`. Adds its previous accessor to
/// `replaced`.
void replace_triangles(GltfContents& contents, Json& primitive, std::span<const glm::uvec3> triangles,
                       bool mirrored, std::set<std::size_t>& replaced);

} // namespace prt
