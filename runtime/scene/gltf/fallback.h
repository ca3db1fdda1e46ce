#pragma once

#include "gltf/contents.h"

namespace prt {

/// An attribute of a primitive with a fallback: its own colors in a file, and once a file is loaded those of
/// the fallback, which go with the transfer.
inline constexpr const char* kOtherColors = "_PRT_COLOR_0";

/// Puts a file that was loaded back to what it is without its fallback: colors of vertices and materials.
void set_fallback_aside(GltfContents& contents);

} // namespace prt
