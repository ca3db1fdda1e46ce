#pragma once

// Meshes whose edges are short everywhere, whatever light does.

#include "prt/scene.h"

namespace prt {

/// `scene` with triangles split at their longest edges until none is longer than `longest`, metres, or would
/// be too short beside the scene to be split. Vertices that were there come first in their arrays.
Scene with_short_edges(const Scene& scene, double longest);

} // namespace prt
