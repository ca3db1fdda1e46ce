#pragma once

// Predictors and offsets of PRTKIT_clustered_pca (docs/format.md).

#include "runtime/scene/gltf/transfer_json.h"

namespace prt {

/// Writes predictors and offsets into `extension`; nothing if `bases` has none. Origins of predictors are
/// converted to the file's world.
void write_predictors(GltfContents& contents, const Scene& scene, const ClusteredBases& bases,
                      Json& extension);

/// Reads predictors, and offsets of the clusters of `bases`. Throws `Error` if they are invalid.
void read_predictors(const GltfContents& contents, const Scene& scene, const Json& extension,
                     ClusteredBases& bases);

/// Returns the predictor coordinates of all receivers of `scene`. Throws `Error` if they need too much
/// memory, or exceed the maximum weight.
std::vector<float> read_coordinates(const GltfContents& contents, const Scene& scene,
                                    const ClusteredBases& bases);

} // namespace prt
