#pragma once

// Encodes glTF files in memory, without writing to disk. Experimental.

#include "prt/gltf/gltf.h"

#include <cstddef>
#include <vector>

namespace prt {

/// Returns `document` as a .glb file in memory, with all data: the bytes that `save_glb` writes for the same
/// arguments. `compression`: of vertex and index data. Throws `Error` if the file would exceed 4 GB, or if
/// `document` is damaged.
std::vector<std::byte> encode_glb(const GltfDocument& document,
                                  BufferCompression compression = BufferCompression::none);

} // namespace prt
