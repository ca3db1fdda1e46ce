#pragma once

// Checks of a glTF file's JSON before it is read.

#include "runtime/load/gltf_data.h"

namespace prt {

/// Throws `Error` with the location if the JSON does not have the structure that prtkit and tinygltf (in
/// bake/gltf) read: lists of objects, non-negative integers for indices, counts and lengths, primitives with
/// attributes. Without this check, tinygltf would substitute or drop invalid values, and its model would
/// differ from the JSON. Also throws if tinygltf would need too much memory for a text of `text_bytes`.
/// Returns false if extras and extensions that bake/gltf does not take from tinygltf are large: it then reads
/// `without_unread`.
bool check_shape(const Json& json, std::size_t text_bytes);

/// Throws `Error` for a buffer view that exceeds the length of its buffer in the JSON, and for a second
/// buffer without a URI, which would be a copy of the first.
void check_views(const Json& json);

} // namespace prt
