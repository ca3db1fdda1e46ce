#pragma once

// Writing of buffer views with EXT_meshopt_compression, and JSON without it for tinygltf.

#include "bake/gltf/contents.h"

namespace prt {

/// Returns `json` for a loader without the extension: compressed views are plain bytes, and fallback buffers
/// without data are a few bytes in the JSON.
Json without_meshopt(Json json);

/// The JSON and the binary chunk of a GLB with compressed vertex and index data. Views with other data, or
/// with a layout that the extension does not support, are not changed.
struct CompressedGlb {
    Json json;
    std::vector<std::byte> binary;
};
CompressedGlb compress_views(const GltfContents& contents);

} // namespace prt
