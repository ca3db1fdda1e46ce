#pragma once

#include "support/glb_file.h"

#include <span>

namespace prt::test {

/// How a file marks nodes as levels of detail.
enum class LevelsBy { extension, names };

/// Adds coarser levels to each node with a mesh, simplified by meshoptimizer to about these fractions of its
/// triangles: as nodes outside the scene with MSFT_lod, or as named siblings. Their vertices have positions
/// and normals.
GlbFile with_levels(GlbFile file, std::span<const float> shares, LevelsBy by = LevelsBy::extension);

} // namespace prt::test
