#pragma once

// Guides and centers of PRTKIT_clustered_pca (docs/format.md).

#include "gltf/transfer_json.h"

namespace prt {

/// Writes guides and centers into `extension`; nothing where `bases` has none. Origins of guides become
/// places in the file's world.
void write_guides(GltfContents& contents, const Scene& scene, const ClusteredBases& bases, Json& extension);

/// Reads guides and centers of as many clusters as `bases` has. Throws `Error` where they make no sense.
void read_guides(const GltfContents& contents, const Scene& scene, const Json& extension,
                 ClusteredBases& bases);

/// Coordinates of guides for all receivers of `scene`. Throws `Error` where they take too much memory, or are
/// beyond what a weight may be.
std::vector<float> read_coordinates(const GltfContents& contents, const Scene& scene,
                                    const ClusteredBases& bases);

} // namespace prt
