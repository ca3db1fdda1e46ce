#pragma once

// Buffer views compressed with EXT_meshopt_compression or KHR_meshopt_compression.

#include "runtime/load/gltf_data.h"

namespace prt {

/// Renames KHR_meshopt_compression (gltfpack 1.x), which has the same members, to EXT_meshopt_compression.
/// Returns whether it was present.
bool use_ext_meshopt(Json& json);

/// Returns whether any buffer view of `json` is compressed.
bool has_meshopt_views(const Json& json);

/// Decompresses the views of `data`, in its JSON and its model, into new buffers. Throws `Error` with the
/// view if the data is damaged.
void decompress_views(GltfData& data);

} // namespace prt
