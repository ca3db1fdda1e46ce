#pragma once

// What Draco's decoder gives, as glTF lays it out.

#include <draco/mesh/mesh.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace prt {

/// Decodes a compressed mesh. Throws `Error` where the data is damaged, or claims more than it can hold.
std::unique_ptr<draco::Mesh> decode_draco(std::span<const unsigned char> bytes);

/// The corners of all triangles, as indices of `component_type`: unsigned short or int.
std::vector<std::byte> draco_indices(const draco::Mesh& mesh, int component_type);

/// The elements of an attribute, each padded to whole groups of 4 bytes, and their bounds.
struct DracoAttribute {
    std::vector<std::byte> bytes;
    std::size_t stride = 0;
    std::vector<double> low, high;
};

/// The attribute with that unique id, an element for each point. Throws `Error` where it is not there, or has
/// not the components of the accessor that it is for.
DracoAttribute draco_attribute(const draco::Mesh& mesh, int id, int component_type, int components);

} // namespace prt
