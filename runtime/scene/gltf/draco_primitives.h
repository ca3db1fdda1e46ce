#pragma once

// Primitives that are compressed with KHR_draco_mesh_compression.

#include "gltf/contents.h"

namespace prt {

inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

/// Whether any primitive of `json` is compressed.
bool has_draco_primitives(const Json& json);

/// `json` as a loader without the extension can read it: without indices that are only there compressed.
Json without_draco_indices(Json json);

/// Gives the compressed primitives of `contents`, whose model was loaded from what without_draco_indices made
/// of its JSON, plain accessors, in both alike; the decoded data goes into new buffers. Where the file has
/// uncompressed data beside it and does not require the extension, that is used. Accessors and views keep
/// their numbers. Throws `Error` that names the primitive where the data is damaged, or does not fit what the
/// file says of it.
void decompress_primitives(GltfContents& contents);

} // namespace prt
