#pragma once

// Predictors and offsets of clustered transfer (docs/format.md).

#include "runtime/load/transfer_json.h"

namespace prt {

/// Reads predictors, and offsets of the clusters of `bases`. Throws `Error` if they are invalid.
void read_predictors(const GltfData& data, const Scene& scene, const Json& extension, ClusteredBases& bases);

/// Returns the predictor coordinates of all receivers of `scene`, for `bases` of `read_clustered`. Throws
/// `Error` if they need too much memory.
std::vector<float> read_coordinates(const GltfData& data, const Scene& scene, const ClusteredBases& bases);

} // namespace prt
