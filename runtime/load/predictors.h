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

/// Throws `Error` if a coordinate of a receiver of `scene`, times its scale, exceeds `kMaxFloatWeight`.
void check_predictors(const Scene& scene, std::span<const Predictor> predictors);

} // namespace prt
