#pragma once

// Packed words of vertices as files keep them: entropy-coded beside the attributes (docs/format.md).

#include "gltf/contents.h"

#include <optional>

namespace prt {

/// Puts attributes _PRT_WEIGHTS_ in the place of coded words, in the JSON and the model of `contents`. Throws
/// `Error` where they are damaged.
void decode_vertices(GltfContents& contents);

/// `contents` with coded words in the place of attributes _PRT_WEIGHTS_; nothing where it has no packed
/// words, or such as no code can hold. `read`: the same contents, whose model knows what was changed.
std::optional<GltfContents> with_coded_vertices(const GltfContents& contents, const GltfContents& read);

} // namespace prt
