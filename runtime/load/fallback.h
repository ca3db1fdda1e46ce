#pragma once

// Fallback colors of a file for viewers without support for the extensions of prtkit (docs/format.md).

#include "runtime/load/gltf_data.h"

#include <set>

namespace prt {

inline constexpr const char* kUnlitExtension = "KHR_materials_unlit";
/// Mark in the extras of an extension that makes a material unlit for the fallback.
inline constexpr const char *kFallbackMark = "prtkit", *kFallbackMarked = "fallback";
/// Attribute of a primitive with a fallback. In a file it holds the original colors; in a loaded document it
/// holds the fallback colors, which are removed with the transfer.
inline constexpr const char* kOtherColors = "_PRT_COLOR_0";

/// Returns the index of a primitive's material in the file; -1 if it has none.
int material_of(const Json& primitive);
bool is_unlit(const Json& material);

/// Restores the original colors and materials of a loaded file that has a fallback. Returns the materials
/// that are no longer unlit.
std::set<int> set_fallback_aside(GltfData& data);

} // namespace prt
