#pragma once

// A bounding volume hierarchy for GPUs: H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray Traversal
// on GPUs Through Compressed Wide BVHs", HPG 2017. Eight children a node, their boxes on a grid of 8 bits an
// axis.

#include "trace/gpu/gpu_structs.h"

#include <vector>

namespace prt {

struct WideBvh {
    std::vector<gpu::WideNode> nodes = {};     ///< the root is the first
    std::vector<std::uint32_t> triangles = {}; ///< in the order of the leaves: index in the scene's order
    int depth = 0;                             ///< levels of nodes
};

/// Built by Embree's builder. `positions` [receivers], `corners` [triangles]. Throws `Error` when memory runs
/// out.
WideBvh build_wide_bvh(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& corners,
                       int threads);

} // namespace prt
