#pragma once

// The JSON of a glTF file.

#include "gltf/contents.h"

#include <string_view>

namespace prt {

/// The glTF that `text` holds. Throws `Error` where it is none, and with the line and column where it is
/// damaged or nests deeper than the readers of JSON, which call themselves, have stack for.
Json parse_json(std::string_view text);

/// Removes members that are null, which some exporters write for "not given", from all objects but extras
/// and the extensions of prtkit. Returns their number.
std::size_t remove_nulls(Json& json);

/// Whether the reader takes an extension from tinygltf's model, and not from the JSON alone.
bool is_taken_extension(std::string_view name);

/// A copy of a glTF without extras and without extensions that only the JSON holds for the reader: tinygltf
/// keeps ten times the memory for each value of theirs.
Json without_unread(const Json& json);

/// Bytes that `json` takes in memory, about.
double json_bytes(const Json& json);

} // namespace prt
