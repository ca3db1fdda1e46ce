#pragma once

// Reading of glTF accessors.

#include "prt/core/error.h"
#include "runtime/load/gltf_model.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Returns an accessor. Throws `Error` if it does not exist.
const GltfAccessor& get_accessor(const GltfModel& model, int accessor);

/// Throws `Error` with the accessor's index if it, or its sparse data, exceeds its buffer view or buffer.
/// Returns the size of an element in bytes.
std::size_t check_accessor(const GltfModel& model, int accessor);

/// Returns the elements of an accessor, tightly packed, with sparse substitutions. Throws `Error` with the
/// accessor's index if it exceeds its buffer view or buffer.
std::vector<std::byte> read_elements(const GltfModel& model, int accessor);

/// Returns the elements of an accessor where they are in its buffer, if they are tightly packed floats
/// (unsigned integers of 32 bits) with `components` components; otherwise an empty list. Throws the errors of
/// `read_elements`.
std::span<const float> floats_in_place(const GltfModel& model, int accessor, int components);
std::span<const std::uint32_t> integers_in_place(const GltfModel& model, int accessor, int components);

/// Returns elements converted to float, normalised integers to [0, 1] or [-1, 1]; [count][components]. Throws
/// `Error` unless the accessor has `components` components.
std::vector<float> read_floats(const GltfModel& model, int accessor, int components);

/// Returns the elements of a scalar or vector of unsigned integers.
std::vector<std::uint32_t> read_unsigned(const GltfModel& model, int accessor, int components);

/// Returns the bytes of a buffer view. Throws `Error` if it does not exist or exceeds its buffer.
std::span<const std::byte> buffer_view_bytes(const GltfModel& model, int view);

/// Calls `body` with a value of the C++ type of a component type. Throws `Error` for an unknown one.
template <class Body>
void with_component_type(int component_type, Body&& body) {
    switch (component_type) {
    case kSignedByte:
        return body(std::int8_t{});
    case kUnsignedByte:
        return body(std::uint8_t{});
    case kSignedShort:
        return body(std::int16_t{});
    case kUnsignedShort:
        return body(std::uint16_t{});
    case kUnsignedInt:
        return body(std::uint32_t{});
    case kFloat:
        return body(float{});
    default:
        throw Error("unknown component type " + std::to_string(component_type));
    }
}

std::size_t component_bytes(int component_type);

} // namespace prt
