#pragma once

// Vertex order that groups the clusters of compressed transfer. Experimental.

#include "prt/clustered_transfer.h"
#include "prt/gltf.h"

#include <cstdint>
#include <vector>

namespace prt {

/// Returns for every index in memory the receiver that moves there: within each vertex array sorted by
/// cluster, otherwise in the previous order.
std::vector<std::uint32_t> order_by_cluster(const Scene& scene, const ClusteredReceivers& receivers);

/// Returns `receivers` with receiver order[i] at index i.
ClusteredReceivers reordered(const ClusteredReceivers& receivers, std::span<const std::uint32_t> order);

/// Reorders the vertices of `document`, with attributes, morph targets and indices. `scene` must be extracted
/// from it, and the document must hold it one to one, as written by prt bake. The drawn picture does not
/// change.
void reorder_vertices(GltfDocument& document, const Scene& scene, std::span<const std::uint32_t> order);

/// Returns for every receiver of `scene` the receiver of `other` with the same position and normal; of
/// several equal receivers the first is matched first. Throws `Error` if the two scenes do not have the same
/// receivers.
std::vector<std::uint32_t> matching_receivers(const Scene& scene, const Scene& other);

/// Returns `transfer` of the receivers of `other` in the order of `scene`. This is needed because compression
/// may reorder the vertices of a file. Throws as `matching_receivers`.
Transfer in_order_of(const Scene& scene, const Scene& other, const Transfer& transfer);

/// Efficiency of vertex reuse and fetching on a GPU for all triangles in order, by meshoptimizer's analysis.
struct VertexReuse {
    double transforms_per_triangle = 0; ///< bytes fetched in lines of 64 bytes, divided by bytes of positions
    double overfetch = 0;               ///< bytes fetched over bytes of positions, lines of 64 bytes
};
VertexReuse vertex_reuse(const Scene& scene);

} // namespace prt
