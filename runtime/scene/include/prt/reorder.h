#pragma once

// The order of vertices: that in which the clusters of compressed transfer lie together. Experimental.

#include "prt/clustered_transfer.h"
#include "prt/gltf.h"

#include <cstdint>
#include <vector>

namespace prt {

/// For every place in memory the receiver that goes there: within each vertex array by cluster, else as
/// before.
std::vector<std::uint32_t> order_by_cluster(const Scene& scene, const ClusteredReceivers& receivers);

/// `receivers` with receiver order[i] at place i.
ClusteredReceivers reordered(const ClusteredReceivers& receivers, std::span<const std::uint32_t> order);

/// Moves the vertices of `document`, from which `scene` was extracted and which holds it one to one, as prt
/// bake writes it: attributes, morph targets and indices follow. Draws what it drew.
void reorder_vertices(GltfDocument& document, const Scene& scene, std::span<const std::uint32_t> order);

/// For every receiver of `scene` the one of `other` that has the same position and normal; the first comes
/// first where several do. Throws `Error` where the two do not hold the same receivers.
std::vector<std::uint32_t> matching_receivers(const Scene& scene, const Scene& other);

/// `transfer` of the receivers of `other` in the order that they have in `scene`: a file's vertices may have
/// moved when it was compressed. Throws as `matching_receivers` does.
Transfer in_order_of(const Scene& scene, const Scene& other, const Transfer& transfer);

/// How well a GPU reuses and fetches the vertices of all triangles in their order, by meshoptimizer's
/// analysis.
struct VertexReuse {
    double transforms_per_triangle = 0; ///< with a cache of 16 vertices
    double overfetch = 0;               ///< bytes fetched over bytes of positions, lines of 64 bytes
};
VertexReuse vertex_reuse(const Scene& scene);

} // namespace prt
