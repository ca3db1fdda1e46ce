#pragma once

// Parsing of a glTF file's JSON.

#include "runtime/load/gltf_data.h"

#include <string_view>

namespace prt {

/// Parses glTF JSON. Throws `Error` if `text` is not glTF; with line and column if it is damaged, or nested
/// too deeply for recursive JSON readers.
Json parse_json(std::string_view text);

/// Removes null members, which some exporters write for missing values, from all objects except extras and
/// the extensions of prtkit. Returns their number.
std::size_t remove_nulls(Json& json);

/// Returns whether bake/gltf takes an extension from the model of tinygltf, not from the JSON alone.
bool is_taken_extension(std::string_view name);

/// Returns a copy of a glTF without extras and without extensions that bake/gltf reads from the JSON alone:
/// tinygltf keeps ten times the memory for each value of theirs.
Json without_unread(const Json& json);

/// Returns the approximate memory size of `json` in bytes.
double json_bytes(const Json& json);

} // namespace prt
