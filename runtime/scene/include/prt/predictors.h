#pragma once

// Predictor coordinates (`Predictor` of prt/clustered_bases.h) at the receivers of a scene. Stable.

#include "prt/clustered_bases.h"
#include "prt/scene.h"

#include <span>
#include <vector>

namespace prt {

/// Returns the coordinates of each receiver of `scene` in `predictors`, predictor by predictor: its normal,
/// or its position relative to the predictor's origin. [receivers][3 predictors.size()], as in
/// ClusteredReceivers::predictors.
std::vector<float> predictor_coordinates(const Scene& scene, std::span<const Predictor> predictors);

} // namespace prt
