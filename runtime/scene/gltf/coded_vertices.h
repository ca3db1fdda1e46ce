#pragma once

// Entropy-coded words of vertices in files, stored outside the attributes (docs/format.md).

#include "runtime/scene/gltf/contents.h"

#include <optional>

namespace prt {

/// Replaces coded words by attributes _PRT_WEIGHTS_, in the JSON and the model of `contents`. Throws `Error`
/// if the words are damaged.
void decode_vertices(GltfContents& contents);

/// Returns `contents` with coded words instead of attributes _PRT_WEIGHTS_; empty if there are no packed
/// words, or if the code cannot represent them. `read`: the same contents, with an up-to-date model.
std::optional<GltfContents> with_coded_vertices(const GltfContents& contents, const GltfContents& read);

} // namespace prt
