// Computes the positions of samples of texels, on the scene or on a finer model.

#include "bake/products/lightmaps/texel_positions.h"

#include "prt/core/error.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

namespace prt {
namespace {

glm::vec3 at_position(const std::vector<glm::vec3>& values, const glm::uvec3& c, const glm::vec2& uv) {
    return values[c.x] * (1 - uv.x - uv.y) + values[c.y] * uv.x + values[c.z] * uv.y;
}

/// Towards the front; zero without an area.
glm::vec3 plane_of(const std::vector<glm::vec3>& positions, const glm::uvec3& c) {
    const glm::dvec3 a(positions[c.x]),
        face = glm::cross(glm::dvec3(positions[c.y]) - a, glm::dvec3(positions[c.z]) - a);
    const double doubled = glm::length(face);
    return doubled > 0 ? glm::vec3(face / doubled) : glm::vec3(0);
}

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& otherwise) {
    const float length = glm::length(v);
    return length > 0 ? v / length : otherwise;
}

} // namespace

TexelPositions::TexelPositions(const Scene& scene, const Casters* casters)
    : vertices_(vertex_receivers(scene)), casters_(casters) {
    for (const Primitive& primitive : scene.primitives) {
        const auto first = static_cast<std::uint32_t>(scene.vertex_arrays[primitive.vertices].first_receiver);
        for (const glm::uvec3& t : primitive.triangles)
            corners_.push_back(t + first);
    }
    if (casters) {
        of_casters_ = vertex_receivers(casters->scene.scene());
        from_scene_ = glm::vec3(scene.origin - casters->scene.scene().origin);
    }
}

void TexelPositions::move_to_casters(Position& point) const {
    const auto reach = static_cast<float>(casters_->reach);
    const glm::vec3 here = point.position + from_scene_;
    point.position = here;
    const Surfaces& surfaces = casters_->scene.surfaces();
    const auto faces_alike = [&](unsigned triangle) {
        return glm::dot(plane_of(of_casters_.positions, surfaces.corners(triangle)), point.normal) > 0;
    };
    const Ray ray{here + reach * point.normal, -point.normal, 0, 2 * reach};
    const std::optional<RayHit> hit = casters_->scene.rays().nearest(ray, faces_alike);
    ++asked_;
    if (!hit)
        return;
    ++found_;
    const glm::uvec3& c = surfaces.corners(hit->triangle);
    point.position = at_position(of_casters_.positions, c, hit->uv);
    point.plane = plane_of(of_casters_.positions, c);
    point.normal = unit_or(at_position(of_casters_.normals, c, hit->uv), point.plane);
}

std::optional<std::string> TexelPositions::check_casters() const {
    constexpr double kMany = 0.02;
    const std::size_t asked = asked_, found = found_;
    if (asked > 0 && found == 0)
        throw Error(fmt::format(
            "no texel is within {:g} m of the surface of the high-poly model; check its position or "
            "use a larger --high-poly distance",
            casters_->reach));
    const double missing = asked > 0 ? 1 - static_cast<double>(found) / static_cast<double>(asked) : 0;
    if (missing <= kMany)
        return std::nullopt;
    return fmt::format(
        "{:.1f} % of the texels are not within {:g} m of the surface of the high-poly model and use the "
        "low-poly surface; use a larger --high-poly distance",
        100 * missing, casters_->reach);
}

double TexelPositions::area(std::uint32_t triangle) const {
    const glm::uvec3& c = corners_[triangle];
    const auto& positions = vertices_.positions;
    const glm::dvec3 a(positions[c.x]);
    return glm::length(glm::cross(glm::dvec3(positions[c.y]) - a, glm::dvec3(positions[c.z]) - a)) / 2;
}

void TexelPositions::append(const TexelSample& sample, float area, Receivers& receivers) const {
    const glm::uvec3& c = corners_[sample.triangle];
    Position point{at_position(vertices_.positions, c, sample.uv), {}, plane_of(vertices_.positions, c)};
    point.normal = unit_or(at_position(vertices_.normals, c, sample.uv), point.plane);
    if (point.plane == glm::vec3(0))
        point.plane = point.normal;
    if (casters_)
        move_to_casters(point);
    receivers.positions.push_back(point.position);
    receivers.normals.push_back(point.normal);
    receivers.starts.push_back(point.plane);
    receivers.areas.push_back(area);
}

} // namespace prt
