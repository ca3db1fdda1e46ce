#pragma once

// Fallback colors of a file.

#include "runtime/scene/gltf/contents.h"

namespace prt {

/// Attribute of a primitive with a fallback. In a file it holds the original colors; in a loaded document it
/// holds the fallback colors, which are removed with the transfer.
inline constexpr const char* kOtherColors = "_PRT_COLOR_0";

/// Restores the original colors and materials of a loaded file that has a fallback.
void set_fallback_aside(GltfContents& contents);

} // namespace prt
