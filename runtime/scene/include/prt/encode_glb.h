#pragma once

// glTF files in memory. Experimental.

#include "prt/gltf.h"

#include <cstddef>
#include <vector>

namespace prt {

/// Returns the bytes that `save_glb` writes. Throws `Error` if they exceed 4 GB.
std::vector<std::byte> encode_glb(const GltfDocument& document,
                                  BufferCompression compression = BufferCompression::none);

} // namespace prt
