// Computes the side of a triangle that a ray hit.

#include "bake/scene/lit_side.h"

#include "bake/scene/interpolated.h"

#include <glm/common.hpp>

namespace prt {

MetSurface met_surface(const Scene& scene, const RayScene& rays, const SurfacePoint& point,
                       const glm::vec3& along) {
    const RayScene::Triangle triangle = rays.triangle(point.triangle);
    const Primitive& primitive = scene.primitives[triangle.primitive];
    const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
    const glm::uvec3& t = primitive.triangles[triangle.triangle];
    const glm::vec3 face = glm::cross(vertices.positions[t.y] - vertices.positions[t.x],
                                      vertices.positions[t.z] - vertices.positions[t.x]);
    const glm::vec3 normal = interpolated(vertices.normals, t, point.uv);
    const bool back = glm::dot(face, along) > 0;
    LitSide side{interpolated(vertices.positions, t, point.uv),
                 glm::normalize(back ? -face : face),
                 {},
                 rays.triangle_offset(point.triangle)};
    const float length = glm::length(normal);
    side.normal = length > 0 ? (back ? -normal : normal) / length : side.face;
    return {side, back};
}

Scattering seen_scattering(const Surfaces& surfaces, const SurfacePoint& point, bool textured) {
    if (!surfaces.transmits(point.triangle))
        return {textured ? surfaces.base_color(point) : glm::vec3(1), glm::vec3(0)};
    const Scattering scattering = surfaces.scattering(point);
    if (textured)
        return scattering;
    const glm::vec3 base = glm::max(surfaces.base_color(point), glm::vec3(1e-6f));
    return {scattering.reflected / base, scattering.transmitted / base};
}

} // namespace prt
