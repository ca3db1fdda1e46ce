#pragma once

// Meshes whose edges are short everywhere, whatever light does.

#include "prt/scene.h"

#include <cstdint>
#include <vector>

namespace prt {

struct EvenScene {
    Scene scene;
    std::vector<std::uint32_t> whole; ///< [triangles] triangle of the scene before that each is a part of
};

/// `scene` with triangles split at their longest edges until none is longer than `longest`, metres, or would
/// be too short beside the scene to be split. Vertices that were there come first in their arrays.
EvenScene with_short_edges(const Scene& scene, double longest);

} // namespace prt
