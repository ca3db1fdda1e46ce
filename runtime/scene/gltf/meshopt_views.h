#pragma once

// Buffer views that are compressed with EXT_meshopt_compression or KHR_meshopt_compression.

#include "gltf/contents.h"

namespace prt {

inline constexpr const char* kMeshoptExtension = "EXT_meshopt_compression";

/// Renames KHR_meshopt_compression (gltfpack 1.x), which has the same members, to EXT_meshopt_compression.
/// Returns whether it was there.
bool use_ext_meshopt(Json& json);

/// Whether any buffer view of `json` is compressed.
bool has_meshopt_views(const Json& json);

/// `json` as a loader without the extension can read it: compressed views are plain bytes, and buffers that
/// are only there as a fallback are a few bytes in the JSON.
Json without_meshopt(Json json);

/// Decompresses the views of `contents.json`, whose model was loaded from what without_meshopt made of it.
/// Throws `Error` that names the view where the data is damaged.
void decompress_views(GltfContents& contents);

/// The JSON and the binary chunk of a GLB in which vertex and index data is compressed. Views that hold other
/// data, or are laid out in a way that the extension does not know, stay as they are.
struct CompressedGlb {
    Json json;
    std::vector<std::byte> binary;
};
CompressedGlb compress_views(const GltfContents& contents);

} // namespace prt
