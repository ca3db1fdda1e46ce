#pragma once

// Whether the parts of a glTF file fit each other.

#include "gltf/contents.h"

namespace prt {

/// Throws `Error` with the place where a buffer view passes its buffer, an accessor or a part of a sparse one
/// its view, where something that a primitive names is not there, and where an attribute or morph target has
/// another length than POSITION, whether anything reads it or not: what is written comes from all of them.
void check_data(const GltfContents& contents);

} // namespace prt
