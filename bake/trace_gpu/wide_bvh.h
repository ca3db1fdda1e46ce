#pragma once

// A bounding volume hierarchy for GPUs: H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray Traversal
// on GPUs Through Compressed Wide BVHs", HPG 2017. A node has eight children, whose boxes are on a grid of 8
// bits per axis.

#include "shared_structs.h"

#include <vector>

namespace prt {

struct WideBvh {
    std::vector<gpu::WideNode> nodes = {};     ///< the root is the first node
    std::vector<std::uint32_t> triangles = {}; ///< indices in the scene's order, in the order of the leaves
    int depth = 0;                             ///< levels of nodes
};

/// Builds the hierarchy with Embree's builder. `positions` [receivers], `corners` [triangles]. Throws `Error`
/// when memory runs out.
WideBvh build_wide_bvh(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& corners,
                       int threads);

} // namespace prt
