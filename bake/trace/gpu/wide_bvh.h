#pragma once

// A bounding volume hierarchy for GPUs: H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray Traversal
// on GPUs Through Compressed Wide BVHs", HPG 2017. Eight children a node, their boxes on a grid of 8 bits an
// axis.

#include "prt/scene.h"

#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace prt {

/// Node, 80 bytes. Child boxes are origin + q · 2^exponent, rounded outwards.
struct WideNode {
    float origin[3];
    std::uint8_t exponents[3]; ///< biased by 127, as in a float
    std::uint8_t unused;
    std::uint32_t first_child;    ///< node index of the first inner child
    std::uint32_t first_triangle; ///< of the leaves' triangles
    /// Per slot: 0 empty; 0x80 | i: inner, node first_child + i; else a leaf of (meta >> 5) triangles from
    /// first_triangle + (meta & 31) on. Slots are ordered by octant, so that a ray finds near ones first.
    std::uint8_t meta[8];
    std::uint8_t low[3][8], high[3][8]; ///< [axis][slot]
};
static_assert(sizeof(WideNode) == 80);

struct WideBvh {
    std::vector<WideNode> nodes;          ///< the root is the first
    std::vector<std::uint32_t> triangles; ///< in the order of the leaves: index in the scene's order
    int depth = 0;                        ///< levels of nodes
};

/// Built by Embree's builder. `positions` [receivers], `corners` [triangles]. Throws `Error` when memory runs
/// out.
WideBvh build_wide_bvh(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& corners,
                       int threads);

} // namespace prt
