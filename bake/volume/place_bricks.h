#pragma once

// Where the bricks of a volume are: fine ones where surfaces are, coarse ones in the open.

#include "prt/scene.h"
#include "prt/volume_bake.h"

#include <cstddef>

namespace prt {

/// Those of the options, or of the scene. Throws `Error` where they are none.
Bounds volume_bounds(const Scene& scene, const VolumeOptions& options);

/// Throws `Error` for bounds or a spacing that make no volume, and one that would not fit.
/// `most` bricks are made before it is known.
VolumeGrid place_bricks(const Scene& scene, const VolumeOptions& options, std::size_t most);

} // namespace prt
