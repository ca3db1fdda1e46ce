#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Vertices with normals, split at sharp edges.
struct SmoothVertices {
    std::vector<std::uint32_t> source; ///< [vertices] index of the original vertex
    std::vector<glm::vec3> normals;    ///< [vertices] unit
    std::vector<glm::uvec3> triangles; ///< indices of these vertices
};

/// Computes normals that are smooth across edges whose triangles meet at `degrees` or less. Vertices at the
/// same position count as one. A normal is the mean of the triangles' normals, weighted by their angles at
/// the vertex (Thürmer and Wüthrich 1998), which does not depend on how faces are cut into triangles.
/// Triangles without area use a normal that another triangle has at their vertex. Time: n log n.
SmoothVertices smooth_vertices(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                               double degrees);

} // namespace prt
