#pragma once

// Conversion of decoded Draco data to glTF layout.

#include <draco/mesh/mesh.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace prt {

/// Decodes a compressed mesh. Throws `Error` if the data is damaged, or claims more elements than it can
/// contain.
std::unique_ptr<draco::Mesh> decode_draco(std::span<const std::byte> bytes);

/// Returns the corners of all triangles as indices of `component_type`: unsigned short or int.
std::vector<std::byte> draco_indices(const draco::Mesh& mesh, int component_type);

/// The elements of an attribute, each padded to a multiple of 4 bytes, and their bounds.
struct DracoAttribute {
    std::vector<std::byte> bytes;
    std::size_t stride = 0;
    std::vector<double> low, high;
};

/// Returns the attribute with this unique id, one element per point. Throws `Error` if it does not exist, or
/// if its components do not match its accessor.
DracoAttribute draco_attribute(const draco::Mesh& mesh, int id, int component_type, int components);

} // namespace prt
