// Finds faces that meet a receiver, on the CPU, because depth maps cannot show them.

#include "bake/trace_gpu/touching_triangles.h"

#include "runtime/core/support/parallel.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>

namespace prt {
namespace {

constexpr float kNear = 8;      ///< surface offsets: more than the rounding of any vertex of a touching
                                ///< triangle
constexpr double kFlush = 0.99; ///< cosine between the normals
using CornersOfTriangle = std::array<glm::dvec3, 3>;

CornersOfTriangle corners_of(const Scene& scene, RayScene::Triangle id) {
    const Primitive& primitive = scene.primitives[id.primitive];
    const auto& positions = scene.vertex_arrays[primitive.vertices].positions;
    const glm::uvec3& t = primitive.triangles[id.triangle];
    return {glm::dvec3(positions[t.x]), glm::dvec3(positions[t.y]), glm::dvec3(positions[t.z])};
}

/// Whether the triangle's plane passes near `position` and is not nearly parallel to a surface with this
/// normal.
bool touches(const CornersOfTriangle& c, const glm::dvec3& position, const glm::dvec3& normal, double near) {
    const glm::dvec3 area = glm::cross(c[1] - c[0], c[2] - c[0]);
    const double length = glm::length(area);
    return length > 0 && std::abs(glm::dot(area, position - c[0])) <= near * length &&
           std::abs(glm::dot(area, normal)) < kFlush * length;
}

} // namespace

TouchingTriangles touching_triangles(const TraceScene& scene, const Receivers& receivers,
                                     std::span<const std::uint32_t> indices) {
    const RayScene& rays = scene.rays();
    const Surfaces& surfaces = scene.surfaces();
    std::vector<std::vector<glm::vec4>> found(indices.size());
    parallel_for(indices.size(), 256, scene.threads(), [&](std::size_t begin, std::size_t end) {
        std::vector<unsigned> ids;
        for (std::size_t i = begin; i < end; ++i) {
            const glm::vec3& position = receivers.positions[indices[i]];
            const glm::dvec3 normal(receivers.normals[indices[i]]),
                start(rays.ray_origin(receivers, indices[i]));
            const float near = kNear * rays.surface_offset(position);
            rays.triangles_near(position, near, ids);
            for (const unsigned id : ids) {
                const CornersOfTriangle corners = corners_of(surfaces.scene(), rays.triangle(id));
                if (surfaces.opaque(id) && rays.is_traced(id) &&
                    touches(corners, glm::dvec3(position), normal, static_cast<double>(near)))
                    for (const glm::dvec3& corner : corners)
                        found[i].emplace_back(glm::vec3(corner - start), 0);
            }
        }
    });
    TouchingTriangles result;
    for (const auto& corners : found) {
        const auto first = static_cast<unsigned>(result.corners.size() / 3);
        result.corners.insert(result.corners.end(), corners.begin(), corners.end());
        result.ranges.emplace_back(first, static_cast<unsigned>(result.corners.size() / 3));
    }
    return result;
}

} // namespace prt
