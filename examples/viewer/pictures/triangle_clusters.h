#pragma once

// Culling of geometry that the camera does not see, cluster by cluster.

#include "prt/gl_scene.h"
#include "prt/scene.h"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <span>
#include <vector>

namespace viewer {

/// Triangles that lie together, and the box round them.
struct TriangleCluster {
    prt::TriangleRange triangles;
    prt::Bounds box;
};

inline constexpr std::size_t kClusterTriangles = 128;

/// Puts the triangles of `primitive` in spatial order and cuts them into clusters.
std::vector<TriangleCluster> make_triangle_clusters(prt::Primitive& primitive,
                                                    const prt::VertexArray& vertices);

/// Planes a x + b y + c z + d >= 0 that bound what `view_projection` shows (G. Gribb and K. Hartmann, "Fast
/// Extraction of Viewing Frustum Planes", 2001): left, right, bottom, top, near, far. Not normalised.
std::array<glm::vec4, 6> frustum_planes(const glm::mat4& view_projection);

/// False only where all of `box` lies outside of one plane.
bool may_be_visible(const std::array<glm::vec4, 6>& planes, const prt::Bounds& box);

/// What may be visible of `clusters`, neighbouring ranges joined.
std::vector<prt::TriangleRange> visible_ranges(std::span<const TriangleCluster> clusters,
                                               const std::array<glm::vec4, 6>& planes);

} // namespace viewer
