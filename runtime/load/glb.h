#pragma once

// The container format of .glb files.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Returns whether the file starts like a binary glTF.
bool is_glb(std::span<const std::byte> file);

/// Returns the text of the JSON chunk. Throws `Error` if the file is truncated.
std::string_view glb_json(std::span<const std::byte> file);

/// Returns the binary chunk after it; empty if absent. Throws `Error` if it is truncated.
std::span<const std::byte> glb_binary(std::span<const std::byte> file);

/// Returns a version 2 container with both chunks (glTF 2.0 specification, 4.4). Throws `Error` above 4 GB.
std::vector<std::byte> make_glb(std::string json, std::span<const std::byte> binary);

} // namespace prt
