#pragma once

// Vertex order that groups the clusters of compressed transfer. Experimental.

#include "prt/core/clustered_transfer.h"
#include "prt/gltf/gltf.h"

#include <cstdint>
#include <vector>

namespace prt {

/// Returns a new order of receivers, [receivers]: entry i is the present index of the receiver that moves to
/// index i. Receivers stay in the range of their vertex array and are sorted by cluster; receivers of one
/// cluster keep their order. `receivers` are those of `scene`.
std::vector<std::uint32_t> order_by_cluster(const Scene& scene, const ClusteredReceivers& receivers);

/// Returns a copy of `receivers` in which index i has the data of receiver order[i]. `order` is [receivers],
/// each index once.
ClusteredReceivers reordered(const ClusteredReceivers& receivers, std::span<const std::uint32_t> order);

/// Reorders the vertices of `document`, with attributes, morph targets and indices, by a result of
/// `order_by_cluster`. `scene` must be extracted from `document`, and each vertex of the document must be one
/// receiver, as in files of `prt bake`. The drawn picture does not change. PRTKIT_transfer keeps the old
/// order; write transfer in the new order afterwards.
void reorder_vertices(GltfDocument& document, const Scene& scene, std::span<const std::uint32_t> order);

/// Returns the index in `other` of every receiver of `scene`, [receivers of `scene`]. Receivers match if
/// their positions, relative to Scene::origin, and their normals are equal bit by bit and their vertex arrays
/// contain the same receivers in any order. Equal receivers of an array match in their order. Throws `Error`
/// if a receiver of either scene has no match.
std::vector<std::uint32_t> matching_receivers(const Scene& scene, const Scene& other);

/// Returns a copy of `transfer` in which the receivers have the order of `scene`. In `transfer` the receivers
/// have the order of `other`. The two scenes must have the same receivers, but the order may differ, because
/// `prt compress` reorders vertices. Throws the errors of `matching_receivers`.
Transfer in_order_of(const Scene& scene, const Scene& other, const Transfer& transfer);

/// Efficiency of vertex processing on a GPU that draws all triangles of a scene in order, estimated by
/// meshoptimizer.
struct VertexReuse {
    /// Number of vertex shader invocations per triangle, with a cache of 16 vertices. Smaller is better; the
    /// maximum is 3.
    double transforms_per_triangle = 0;
    /// Bytes of positions that are read from memory in cache lines of 64 bytes, divided by the size of all
    /// positions that triangles use. 1 is ideal.
    double overfetch = 0;
};
/// Estimates the efficiency of vertex processing for all triangles of `scene`.
VertexReuse vertex_reuse(const Scene& scene);

} // namespace prt
