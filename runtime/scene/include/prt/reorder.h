#pragma once

// Vertex order that groups the clusters of compressed transfer. Experimental.

#include "prt/clustered_transfer.h"
#include "prt/gltf.h"

#include <cstdint>
#include <vector>

namespace prt {

/// Returns a new order of receivers: entry i is the receiver that moves to index i. Receivers stay within
/// their vertex array and are sorted by cluster; receivers of one cluster keep their order.
std::vector<std::uint32_t> order_by_cluster(const Scene& scene, const ClusteredReceivers& receivers);

/// Returns `receivers` with receiver order[i] at index i.
ClusteredReceivers reordered(const ClusteredReceivers& receivers, std::span<const std::uint32_t> order);

/// Reorders the vertices of `document`, with attributes, morph targets and indices. `scene` must be extracted
/// from it, and each vertex of the document must be one receiver, as in files of `prt bake`. The drawn
/// picture does not change.
void reorder_vertices(GltfDocument& document, const Scene& scene, std::span<const std::uint32_t> order);

/// Returns for every receiver of `scene` the receiver of `other` with the same position and normal. Receivers
/// that are equal are matched in their order. Throws `Error` if the two scenes do not have the same
/// receivers.
std::vector<std::uint32_t> matching_receivers(const Scene& scene, const Scene& other);

/// Returns `transfer`, whose receivers are those of `other`, in the order of the receivers of `scene`. The
/// orders may differ, because compression may reorder the vertices of a file. Throws the errors of
/// `matching_receivers`.
Transfer in_order_of(const Scene& scene, const Scene& other, const Transfer& transfer);

/// Efficiency of vertex processing on a GPU that draws all triangles in order, by the analysis of
/// meshoptimizer.
struct VertexReuse {
    /// Vertex shader invocations per triangle, with a cache of 16 vertices.
    double transforms_per_triangle = 0;
    /// Bytes of positions fetched in cache lines of 64 bytes, divided by the size of all positions.
    double overfetch = 0;
};
/// Computes the efficiency of vertex processing for `scene`.
VertexReuse vertex_reuse(const Scene& scene);

} // namespace prt
