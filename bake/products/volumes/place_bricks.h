#pragma once

// Places the bricks of a volume: fine ones at surfaces, coarse ones in free space.

#include "prt/bake/volume_bake.h"
#include "prt/load/scene.h"

#include <cstddef>

namespace prt {

/// Returns the bounds of the options, or of the scene. Throws `Error` if they are invalid.
Bounds volume_bounds(const Scene& scene, const VolumeOptions& options);

/// Places the bricks. Throws `Error` for invalid bounds or spacing, and if there are more than `most` bricks,
/// which do not fit into memory.
VolumeGrid place_bricks(const Scene& scene, const VolumeOptions& options, std::size_t most);

} // namespace prt
