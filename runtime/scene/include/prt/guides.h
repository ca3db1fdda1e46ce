#pragma once

// Predictor coordinates (`Guide` of prt/clustered_bases.h) at the receivers of a scene. Stable.

#include "prt/clustered_bases.h"
#include "prt/scene.h"

#include <span>
#include <vector>

namespace prt {

/// Returns the coordinates of each receiver of `scene` in `guides`, predictor by predictor: its normal, or
/// its position relative to the guide's origin. [receivers][3 guides.size()], as in
/// ClusteredReceivers::guides.
std::vector<float> guide_coordinates(const Scene& scene, std::span<const Guide> guides);

} // namespace prt
