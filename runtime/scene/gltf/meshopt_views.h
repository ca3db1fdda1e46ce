#pragma once

// Buffer views compressed with EXT_meshopt_compression or KHR_meshopt_compression.

#include "runtime/scene/gltf/contents.h"

namespace prt {

inline constexpr const char* kMeshoptExtension = "EXT_meshopt_compression";

/// Renames KHR_meshopt_compression (gltfpack 1.x), which has the same members, to EXT_meshopt_compression.
/// Returns whether it was present.
bool use_ext_meshopt(Json& json);

/// Returns whether any buffer view of `json` is compressed.
bool has_meshopt_views(const Json& json);

/// Returns `json` for a loader without the extension: compressed views are plain bytes, and fallback buffers
/// without data are a few bytes in the JSON.
Json without_meshopt(Json json);

/// Decompresses the views of `contents.json`; the model must be loaded from the result of without_meshopt.
/// Throws `Error` with the view if the data is damaged.
void decompress_views(GltfContents& contents);

/// The JSON and the binary chunk of a GLB with compressed vertex and index data. Views with other data, or
/// with a layout that the extension does not support, are not changed.
struct CompressedGlb {
    Json json;
    std::vector<std::byte> binary;
};
CompressedGlb compress_views(const GltfContents& contents);

} // namespace prt
