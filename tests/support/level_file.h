#pragma once

#include "support/glb_file.h"

#include <span>

namespace prt::test {

/// How a file says which nodes are levels of detail.
enum class LevelsBy { extension, names };

/// Gives each node that has a mesh coarser levels, by meshoptimizer of about these shares of its triangles:
/// nodes out of the scene and MSFT_lod, or siblings and names. Their vertices have positions and normals.
GlbFile with_levels(GlbFile file, std::span<const float> shares, LevelsBy by = LevelsBy::extension);

} // namespace prt::test
