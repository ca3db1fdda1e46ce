// Computes the positions of samples of texels, on the scene or on a finer model.

#include "texels/texel_places.h"

#include "prt/support/error.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

namespace prt {
namespace {

glm::vec3 at_place(const std::vector<glm::vec3>& values, const glm::uvec3& c, const glm::vec2& uv) {
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

TexelPlaces::TexelPlaces(const Scene& scene, const Casters* casters)
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

void TexelPlaces::move_to_casters(Place& place) const {
    const auto reach = static_cast<float>(casters_->reach);
    const glm::vec3 here = place.position + from_scene_;
    place.position = here;
    const Surfaces& surfaces = casters_->scene.surfaces();
    const auto faces_alike = [&](unsigned triangle) {
        return glm::dot(plane_of(of_casters_.positions, surfaces.corners(triangle)), place.normal) > 0;
    };
    const Ray ray{here + reach * place.normal, -place.normal, 0, 2 * reach};
    const std::optional<RayHit> hit = casters_->scene.rays().nearest(ray, faces_alike);
    ++asked_;
    if (!hit)
        return;
    ++found_;
    const glm::uvec3& c = surfaces.corners(hit->triangle);
    place.position = at_place(of_casters_.positions, c, hit->uv);
    place.plane = plane_of(of_casters_.positions, c);
    place.normal = unit_or(at_place(of_casters_.normals, c, hit->uv), place.plane);
}

std::optional<std::string> TexelPlaces::check_casters() const {
    constexpr double kMany = 0.02;
    const std::size_t asked = asked_, found = found_;
    if (asked > 0 && found == 0)
        throw Error(
            fmt::format("no texel finds a surface of the finer model within {:g} m: it lies somewhere "
                        "else, or --reach is too short",
                        casters_->reach));
    const double missing = asked > 0 ? 1 - static_cast<double>(found) / static_cast<double>(asked) : 0;
    if (missing <= kMany)
        return std::nullopt;
    return fmt::format(
        "{:.1f} % of places of texels find no surface of the finer model within {:g} m, and stay "
        "where they are: --reach looks further",
        100 * missing, casters_->reach);
}

double TexelPlaces::area(std::uint32_t triangle) const {
    const glm::uvec3& c = corners_[triangle];
    const auto& positions = vertices_.positions;
    const glm::dvec3 a(positions[c.x]);
    return glm::length(glm::cross(glm::dvec3(positions[c.y]) - a, glm::dvec3(positions[c.z]) - a)) / 2;
}

void TexelPlaces::append(const TexelSample& sample, float area, Receivers& receivers) const {
    const glm::uvec3& c = corners_[sample.triangle];
    Place place{at_place(vertices_.positions, c, sample.uv), {}, plane_of(vertices_.positions, c)};
    place.normal = unit_or(at_place(vertices_.normals, c, sample.uv), place.plane);
    if (place.plane == glm::vec3(0))
        place.plane = place.normal;
    if (casters_)
        move_to_casters(place);
    receivers.positions.push_back(place.position);
    receivers.normals.push_back(place.normal);
    receivers.starts.push_back(place.plane);
    receivers.areas.push_back(area);
}

} // namespace prt
