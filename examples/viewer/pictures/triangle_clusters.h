#pragma once

// Culls clusters of triangles outside the view.

#include "prt/load/scene.h"
#include "runtime/render/gl/gl_scene.h"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <span>
#include <vector>

namespace viewer {

/// Neighboring triangles, and their bounding box.
struct TriangleCluster {
    prt::TriangleRange triangles;
    prt::Bounds box;
};

inline constexpr std::size_t kClusterTriangles = 128;

/// Sorts the triangles of `primitive` spatially and splits them into clusters.
std::vector<TriangleCluster> make_triangle_clusters(prt::Primitive& primitive,
                                                    const prt::VertexArray& vertices);

/// Returns planes a x + b y + c z + d >= 0 that bound the view of `view_projection` (G. Gribb and K.
/// Hartmann, "Fast Extraction of Viewing Frustum Planes", 2001): left, right, bottom, top, near, far. They
/// are not normalised.
std::array<glm::vec4, 6> frustum_planes(const glm::mat4& view_projection);

/// Returns false only if the whole `box` is outside one plane.
bool may_be_visible(const std::array<glm::vec4, 6>& planes, const prt::Bounds& box);

/// Returns the ranges of `clusters` that may be visible, with adjacent ranges joined.
std::vector<prt::TriangleRange> visible_ranges(std::span<const TriangleCluster> clusters,
                                               const std::array<glm::vec4, 6>& planes);

} // namespace viewer
