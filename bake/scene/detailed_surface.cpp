// Searches a detailed model along the normals of receivers.

#include "bake/scene/detailed_surface.h"

#include "bake/scene/interpolated.h"
#include "prt/core/error.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace prt {
namespace {

/// A vertex on the border of its surface is often on the border of the model, where rays can miss. The search
/// begins at least this far off it, relative to the reach, because `starts` lean towards the vertex's
/// triangles.
constexpr float kOffBorder = 1e-5f;

/// Part of `v` in the plane with unit normal `normal`.
glm::vec3 along(const glm::vec3& v, const glm::vec3& normal) {
    return v - glm::dot(v, normal) * normal;
}

} // namespace

DetailedSurface::DetailedSurface(const TraceScene& model, double reach, const glm::dvec3& origin)
    : model_(model), vertices_(vertex_receivers(model.scene())), reach_(reach),
      from_scene_(origin - model.scene().origin) {}

void DetailedSurface::move(Receivers& receivers, std::size_t first) const {
    const Surfaces& surfaces = model_.surfaces();
    const auto reach = static_cast<float>(reach_);
    for (std::size_t p = first; p < receivers.size(); ++p) {
        glm::vec3 &position = receivers.positions[p], &normal = receivers.normals[p];
        position += from_scene_;
        if (normal == glm::vec3(0))
            continue;
        bool opaque_backs = false;
        const auto side = [&](unsigned triangle) { // 1: front, -1: back, 0: does not face the same way
            const float cosine = glm::dot(plane_of(vertices_.positions, surfaces.corners(triangle)), normal);
            const bool back =
                surfaces.transmits(triangle) || (opaque_backs && surfaces.material(triangle).double_sided);
            return cosine > 0 ? 1.0f : cosine < 0 && back ? -1.0f : 0.0f;
        };
        const float unit = std::max(model_.rays().surface_offset(position), kOffBorder * reach);
        const glm::vec3 from = position + unit * receivers.starts[p];
        const auto nearest = [&] {
            return model_.rays().nearest({from + reach * normal, -normal, 0, 2 * reach},
                                         [&](unsigned triangle) { return side(triangle) != 0; });
        };
        std::optional<RayHit> hit = nearest();
        if (!hit) { // the receiver can be on the back of a double-sided surface
            opaque_backs = true;
            hit = nearest();
        }
        ++searched_;
        if (!hit) {
            ++missing_;
            continue;
        }
        const glm::uvec3& c = surfaces.corners(hit->triangle);
        const float sign = side(hit->triangle);
        const glm::vec3 plane = sign * plane_of(vertices_.positions, c);
        position = interpolated(vertices_.positions, c, hit->uv);
        // The origin keeps its distance from surfaces that meet the triangles of a vertex at their border.
        receivers.starts[p] = plane + along(along(receivers.starts[p], normal), plane);
        normal = unit_or(sign * interpolated(vertices_.normals, c, hit->uv), plane);
    }
}

std::optional<std::string> DetailedSurface::check() const {
    constexpr double kMany = 0.02;
    const std::size_t searched = searched_, missing = missing_;
    if (searched > 0 && missing == searched)
        throw Error(fmt::format(
            "no point of the scene is within {:g} m of the surface of the high-poly model; check its "
            "position or use a larger --high-poly distance",
            reach_));
    const double share = searched > 0 ? static_cast<double>(missing) / static_cast<double>(searched) : 0;
    if (share <= kMany)
        return std::nullopt;
    return fmt::format(
        "{:.1f} % of the points of the scene are not within {:g} m of the surface of the high-poly model and "
        "use the low-poly surface; use a larger --high-poly distance",
        100 * share, reach_);
}

} // namespace prt
