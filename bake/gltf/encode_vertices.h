#pragma once

// Writing of entropy-coded words of vertices (docs/format.md).

#include "bake/gltf/contents.h"

#include <optional>

namespace prt {

/// Returns `contents` with coded words instead of attributes _PRT_WEIGHTS_; empty if there are no packed
/// words, or if the code cannot represent them. `read`: the same JSON, with an up-to-date model.
std::optional<GltfContents> with_coded_vertices(const GltfContents& contents, const GltfData& read);

} // namespace prt
