#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Whether the file starts like a binary glTF.
bool is_glb(std::span<const std::byte> file);

/// The text of the JSON chunk. Throws `Error` when the file ends before it should.
std::string_view glb_json(std::span<const std::byte> file);

/// The binary chunk after it; empty where there is none. Throws `Error` when it is truncated.
std::span<const std::byte> glb_binary(std::span<const std::byte> file);

/// A version 2 container round both chunks (glTF 2.0 specification, 4.4). Throws `Error` above 4 GB.
std::vector<std::byte> make_glb(std::string json, std::span<const std::byte> binary);

} // namespace prt
