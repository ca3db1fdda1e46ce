#pragma once

// Consistency checks of a glTF file.

#include "runtime/load/gltf_data.h"

namespace prt {

/// Throws `Error` with the location if a buffer view exceeds its buffer, an accessor or its sparse data
/// exceeds its view, an object that a primitive references does not exist, or an attribute or morph target
/// has another length than POSITION. Unused data is also checked, because it is written again.
void check_data(const GltfData& data);

} // namespace prt
