#pragma once

// Coordinates of guides (prt/clustered_bases.h) at the receivers of a scene. Stable.

#include "prt/clustered_bases.h"
#include "prt/scene.h"

#include <span>
#include <vector>

namespace prt {

/// For each receiver of `scene` its coordinates in `guides`, one guide after the other: its normal, or its
/// position seen from the guide's origin. [receivers][3 guides.size()], what ClusteredReceivers::guides
/// holds.
std::vector<float> guide_coordinates(const Scene& scene, std::span<const Guide> guides);

} // namespace prt
