#pragma once

// Predictor coordinates (`Predictor` of prt/core/clustered_bases.h) at the receivers of a scene. Stable.

#include "prt/core/clustered_bases.h"
#include "prt/load/scene.h"

#include <span>
#include <vector>

namespace prt {

/// Returns the predictor coordinates of each receiver of `scene`, [receivers][3 predictors.size()], for
/// ClusteredReceivers::predictors. Each predictor has three coordinates: the normal, or
/// VertexArray::positions minus Predictor::origin. The coordinates are not multiplied by Predictor::scale.
std::vector<float> predictor_coordinates(const Scene& scene, std::span<const Predictor> predictors);

/// Maximum magnitude of a float weight, and of a coordinate times its scale; corresponds to `kMaxTransfer`.
inline constexpr float kMaxFloatWeight = 1e9f;

/// Returns the predictor coordinates of each receiver of `scene` for `bases`; empty without predictors.
/// Throws `Error` if a coordinate times its scale exceeds `kMaxFloatWeight`.
std::vector<float> checked_coordinates(const Scene& scene, const ClusteredBases& bases);

} // namespace prt
