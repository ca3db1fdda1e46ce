#pragma once

// Meshes whose edges are short everywhere, independent of light.

#include "prt/load/scene.h"

namespace prt {

/// Splits triangles of `scene` at their longest edges until no edge is longer than `longest`, metres, or the
/// edges are too short to split relative to the scene. Original vertices come first in their arrays.
Scene with_short_edges(const Scene& scene, double longest);

} // namespace prt
