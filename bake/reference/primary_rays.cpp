// Primary rays with the footprints of their pixels, for texture filtering as in OpenGL.

#include "bake/reference/primary_rays.h"

#include "bake/scene/interpolated.h"
#include "bake/scene/opposite_triangles.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace prt {
namespace {

struct Corners {
    glm::vec3 a, b, c;
};

/// Barycentric coordinates (of b and c) of the intersection of the line through `origin` along `direction`
/// with the plane of the triangle.
glm::vec2 plane_barycentrics(const Corners& t, const glm::vec3& origin, const glm::vec3& direction) {
    const glm::dvec3 ab(t.b - t.a), ac(t.c - t.a), d(direction), s(origin - t.a);
    const glm::dvec3 p = glm::cross(d, ac), q = glm::cross(s, ab);
    const double determinant = glm::dot(ab, p);
    return {static_cast<float>(glm::dot(s, p) / determinant),
            static_cast<float>(glm::dot(d, q) / determinant)};
}

/// Directions of the neighbouring rays.
struct NextRays {
    glm::vec3 across, down;
};

/// Filters a texture by the footprint of one sample: the neighbouring rays intersect the triangle's plane, as
/// in dFdx and dFdy.
std::optional<glm::vec4> filtered_texel(const Picture& picture, const VertexArray& vertices,
                                        const TextureUse& use, const Corners& corners, const glm::uvec3& t,
                                        const glm::vec2& uv, const NextRays& next) {
    if (use.image < 0 || picture.textures.empty() || is_missing(use, picture.textures) ||
        static_cast<std::size_t>(use.texcoord) >= vertices.texcoords.size())
        return std::nullopt;
    const auto& set = vertices.texcoords[static_cast<std::size_t>(use.texcoord)];
    const Texture& texture = picture.textures[static_cast<std::size_t>(use.image)];
    const glm::vec3& origin = picture.camera.position;
    const auto coordinate = [&](const glm::vec2& barycentrics) {
        return use.transform * glm::vec3(interpolated(set, t, barycentrics), 1);
    };
    const glm::vec2 size(texture.levels[0].width, texture.levels[0].height);
    const glm::vec2 at = coordinate(uv);
    const glm::vec2 dx = (coordinate(plane_barycentrics(corners, origin, next.across)) - at) * size;
    const glm::vec2 dy = (coordinate(plane_barycentrics(corners, origin, next.down)) - at) * size;
    const float lod = 0.5f * std::log2(std::max(glm::dot(dx, dx), glm::dot(dy, dy)));
    return sample(texture, use, at, std::isfinite(lod) ? lod : 0.0f);
}

} // namespace

PrimaryRays::PrimaryRays(const Picture& picture, const RayScene& rays, int columns, int rows)
    : picture_(picture), rays_(rays), frame_(camera_frame(picture.camera)), columns_(columns), rows_(rows) {}

glm::vec3 PrimaryRays::direction(double x, double y) const {
    return glm::vec3(view_direction(frame_, picture_.width, picture_.height,
                                    (x + 0.5) * picture_.width / columns_,
                                    (y + 0.5) * picture_.height / rows_));
}

float PrimaryRays::solid_angle(int x, int y) const {
    const glm::vec3 along = direction(x, y); // to a plane at distance 1
    const float area = glm::length(glm::cross(direction(x + 1, y) - along, direction(x, y + 1) - along));
    const float distance = glm::length(along);
    return area / (distance * distance * distance);
}

bool PrimaryRays::next(const glm::vec3& along, int x, int y, float& from, SeenSurface& surface) const {
    // Rays hit only one of two opposite triangles.
    const auto seen = [&](unsigned id) {
        glm::vec2 unused(0);
        const SeenSurface here = surface_at(id, along, x, y);
        return here.base.a > 0 || !rays_.opposites().move_to_front(id, unused) ? here
                                                                               : surface_at(id, along, x, y);
    };
    const auto shows = [&](unsigned id) { return seen(id).base.a > 0; };
    const auto hit = rays_.nearest({picture_.camera.position, along, from}, std::ref(shows));
    if (!hit)
        return false;
    surface = seen(hit->triangle);
    from = std::nextafter(hit->distance, std::numeric_limits<float>::infinity());
    return true;
}

SeenSurface PrimaryRays::surface_at(unsigned id, const glm::vec3& along, int x, int y) const {
    const RayScene::Triangle at = rays_.triangle(id);
    const Scene& scene = *picture_.scene;
    const Primitive& primitive = scene.primitives[at.primitive];
    const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
    const Material& material = scene.materials[primitive.material];
    const glm::uvec3& t = primitive.triangles[at.triangle];
    const Corners corners{vertices.positions[t.x], vertices.positions[t.y], vertices.positions[t.z]};
    SeenSurface surface{id, t + static_cast<unsigned>(vertices.first_receiver), {}, glm::vec4(1)};
    const NextRays next{direction(x + 1, y), direction(x, y + 1)};
    const glm::vec3 normal = glm::cross(corners.b - corners.a, corners.c - corners.a);
    if (!material.double_sided && glm::dot(normal, along) >= 0) {
        surface.base.a = 0;
        return surface;
    }
    surface.barycentrics = plane_barycentrics(corners, picture_.camera.position, along);
    if (!picture_.emission.empty() && material.emission.radiance != glm::vec3(0)) {
        surface.emission = material.emission.radiance * picture_.emission[primitive.material];
        if (const auto texel = filtered_texel(picture_, vertices, material.emission.texture, corners, t,
                                              surface.barycentrics, next))
            surface.emission *= glm::vec3(*texel);
        else if (is_missing(material.emission.texture, picture_.textures))
            surface.emission = glm::vec3(0);
    }
    if (!picture_.textured)
        return surface;
    glm::vec4& base = surface.base;
    base = material.base_color;
    if (!vertices.colors.empty())
        base *= interpolated(vertices.colors, t, surface.barycentrics);
    if (const auto texel = filtered_texel(picture_, vertices, material.base_color_texture, corners, t,
                                          surface.barycentrics, next))
        base *= *texel;
    if (material.alpha_mode == AlphaMode::opaque)
        base.a = 1;
    else if (material.alpha_mode == AlphaMode::mask)
        base.a = base.a < material.alpha_cutoff ? 0.0f : 1.0f;
    base.a = std::clamp(base.a, 0.0f, 1.0f);
    return surface;
}

} // namespace prt
