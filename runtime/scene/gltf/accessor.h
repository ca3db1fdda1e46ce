#pragma once

#include "prt/support/error.h"

#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Throws `Error` when it is not there.
const tinygltf::Accessor& get_accessor(const tinygltf::Model& model, int accessor);

/// Throws `Error` naming the accessor when it, or what replaces its elements, reaches outside its buffer view
/// or buffer. Returns the bytes of an element.
std::size_t check_accessor(const tinygltf::Model& model, int accessor);

/// Elements of an accessor, tightly packed, sparse substitutions made. Throws `Error` naming the accessor
/// when it reaches outside its buffer view or buffer.
std::vector<std::byte> read_elements(const tinygltf::Model& model, int accessor);

/// Elements converted to float, normalised integers to [0, 1] or [-1, 1]; [count][components].
/// Throws `Error` unless the accessor has `components` components.
std::vector<float> read_floats(const tinygltf::Model& model, int accessor, int components);

/// Elements of a scalar or vector of unsigned integers.
std::vector<std::uint32_t> read_unsigned(const tinygltf::Model& model, int accessor, int components);

/// The bytes of a buffer view. Throws `Error` when it is not there or reaches outside its buffer.
std::span<const unsigned char> buffer_view_bytes(const tinygltf::Model& model, int view);

/// Calls `body` with a value of the C++ type of a component type. Throws `Error` for an unknown one.
template <class Body>
void with_component_type(int component_type, Body&& body) {
    switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return body(std::int8_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return body(std::uint8_t{});
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return body(std::int16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return body(std::uint16_t{});
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return body(std::uint32_t{});
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return body(float{});
    default:
        throw Error("unknown component type " + std::to_string(component_type));
    }
}

std::size_t component_bytes(int component_type);
int component_count(int type);

/// "SCALAR", "VEC2" ... as tinygltf numbers them. Throws `Error` for another name.
int tinygltf_type(const std::string& name);

} // namespace prt
