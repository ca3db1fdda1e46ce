#pragma once

// What a glTF file's JSON must be before anything reads it.

#include "gltf/contents.h"

namespace prt {

/// Throws `Error` with the place where the JSON is not of the shape that glTF gives it as far as prtkit and
/// tinygltf read it: lists of objects, indices, counts and lengths that are whole numbers and not negative,
/// primitives with attributes. tinygltf takes other values than the JSON has where it is not, and leaves out
/// what it cannot read, so that the two would speak of different things. Also where what tinygltf makes of a
/// text of `text_bytes` would take too much memory. Returns false where extras, and extensions that the
/// reader does not take from tinygltf, are large: read `without_unread` then.
bool check_shape(const Json& json, std::size_t text_bytes);

/// Throws `Error` for a buffer view that passes the length that the JSON gives its buffer, and for a second
/// buffer that has no URI, which would be a copy of the first.
void check_views(const Json& json);

} // namespace prt
