// Builds triangle clusters and tests them against the view frustum.

#include "pictures/triangle_clusters.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <meshoptimizer.h>

#include <algorithm>
#include <limits>

namespace viewer {

std::vector<TriangleCluster> make_triangle_clusters(prt::Primitive& primitive,
                                                    const prt::VertexArray& vertices) {
    std::vector<glm::uvec3>& triangles = primitive.triangles;
    if (triangles.empty())
        return {};
    meshopt_spatialSortTriangles(&triangles[0].x, &triangles[0].x, 3 * triangles.size(),
                                 &vertices.positions[0].x, vertices.size(), sizeof(glm::vec3));
    std::vector<TriangleCluster> clusters;
    for (std::size_t first = 0; first < triangles.size(); first += kClusterTriangles) {
        const std::size_t count = std::min(kClusterTriangles, triangles.size() - first);
        prt::Bounds box{glm::vec3(std::numeric_limits<float>::infinity()),
                        glm::vec3(-std::numeric_limits<float>::infinity())};
        for (std::size_t t = first; t < first + count; ++t)
            for (int corner = 0; corner < 3; ++corner) {
                const glm::vec3& p = vertices.positions[triangles[t][corner]];
                box = {glm::min(box.low, p), glm::max(box.high, p)};
            }
        clusters.push_back({{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)}, box});
    }
    return clusters;
}

std::array<glm::vec4, 6> frustum_planes(const glm::mat4& m) {
    // A point is inside if -w <= x, y, z <= w in clip space: planes are sums and differences of the matrix
    // rows.
    const glm::vec4 x = glm::row(m, 0), y = glm::row(m, 1), z = glm::row(m, 2), w = glm::row(m, 3);
    return {w + x, w - x, w + y, w - y, w + z, w - z};
}

bool may_be_visible(const std::array<glm::vec4, 6>& planes, const prt::Bounds& box) {
    return std::all_of(planes.begin(), planes.end(), [&](const glm::vec4& plane) {
        // The corner farthest inside.
        const glm::vec3 corner(plane.x >= 0 ? box.high.x : box.low.x, plane.y >= 0 ? box.high.y : box.low.y,
                               plane.z >= 0 ? box.high.z : box.low.z);
        return glm::dot(glm::vec3(plane), corner) + plane.w >= 0;
    });
}

std::vector<prt::TriangleRange> visible_ranges(std::span<const TriangleCluster> clusters,
                                               const std::array<glm::vec4, 6>& planes) {
    std::vector<prt::TriangleRange> ranges;
    for (const TriangleCluster& cluster : clusters) {
        if (!may_be_visible(planes, cluster.box))
            continue;
        if (!ranges.empty() && ranges.back().first + ranges.back().count == cluster.triangles.first)
            ranges.back().count += cluster.triangles.count;
        else
            ranges.push_back(cluster.triangles);
    }
    return ranges;
}

} // namespace viewer
