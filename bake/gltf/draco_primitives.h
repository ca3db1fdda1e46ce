#pragma once

// Primitives compressed with KHR_draco_mesh_compression.

#include "bake/gltf/contents.h"

namespace prt {

/// Returns whether any primitive of `json` is compressed.
bool has_draco_primitives(const Json& json);

/// Returns `json` for a loader without the extension: without indices that exist only in compressed form.
Json without_draco_indices(Json json);

/// Replaces the compressed primitives of `contents` by plain accessors, in the JSON and the model; the model
/// must be loaded from the result of without_draco_indices. The decoded data goes into new buffers.
/// Uncompressed data is used if the file has it and does not require the extension. Accessors and views keep
/// their indices. Throws `Error` with the name of the primitive if the data is damaged, or inconsistent with
/// the file.
void decompress_primitives(GltfContents& contents);

} // namespace prt
