// Computes the positions of samples of texels, on the scene or on a finer model.

#include "bake/products/lightmaps/texel_positions.h"

#include "bake/scene/interpolated.h"

#include <glm/geometric.hpp>

namespace prt {

TexelPositions::TexelPositions(const Scene& scene, const DetailedSurface* detail)
    : vertices_(vertex_receivers(scene)), detail_(detail) {
    for (const Primitive& primitive : scene.primitives) {
        const auto first = static_cast<std::uint32_t>(scene.vertex_arrays[primitive.vertices].first_receiver);
        for (const glm::uvec3& t : primitive.triangles)
            corners_.push_back(t + first);
    }
}

double TexelPositions::area(std::uint32_t triangle) const {
    const glm::uvec3& c = corners_[triangle];
    const auto& positions = vertices_.positions;
    const glm::dvec3 a(positions[c.x]);
    return glm::length(glm::cross(glm::dvec3(positions[c.y]) - a, glm::dvec3(positions[c.z]) - a)) / 2;
}

glm::vec3 TexelPositions::position(const TexelSample& sample) const {
    return interpolated(vertices_.positions, corners_[sample.triangle], sample.uv);
}

void TexelPositions::append(const TexelSample& sample, float area, Receivers& receivers, Side side) const {
    const glm::uvec3& c = corners_[sample.triangle];
    const float sign = side == Side::front ? 1.0f : -1.0f;
    const glm::vec3 plane = sign * plane_of(vertices_.positions, c),
                    normal = unit_or(sign * interpolated(vertices_.normals, c, sample.uv), plane);
    receivers.positions.push_back(position(sample));
    receivers.normals.push_back(normal);
    receivers.starts.push_back(plane == glm::vec3(0) ? normal : plane);
    receivers.areas.push_back(area);
    if (detail_)
        detail_->move(receivers, receivers.size() - 1);
}

} // namespace prt
