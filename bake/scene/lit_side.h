#pragma once

// Shading of surfaces in pictures: by interpolated normals, but only on the side of the triangle that faces
// the light.

#include "bake/scene/ray_scene.h"
#include "bake/scene/surfaces.h"

#include <glm/geometric.hpp>

namespace prt {

/// One side of a triangle at a point. Normals are unit and point to that side.
struct LitSide {
    glm::vec3 position, face, normal; ///< `normal` is interpolated between the corners
    float offset;                     ///< RayScene::triangle_offset

    LitSide other() const { return {position, -face, -normal, offset}; }
    /// Whether light from this direction arrives: not from behind the triangle, which shadows the point even
    /// if the interpolated normal faces the light, and not from behind the interpolated normal.
    bool faces(const glm::vec3& towards) const {
        return glm::dot(normal, towards) > 0 && glm::dot(face, towards) > 0;
    }
    /// Origin of rays.
    glm::vec3 origin() const { return position + face * offset; }
};

/// A hit of a ray on a triangle, computed from its barycentric coordinates, because the length of a ray has a
/// larger rounding error.
struct MetSurface {
    LitSide side; ///< side that the ray came from
    bool back;    ///< back of the triangle
};

MetSurface met_surface(const Scene& scene, const RayScene& rays, const SurfacePoint& point,
                       const glm::vec3& along);

/// Returns the scattering of a surface as a camera sees it, which can differ from the scattering of light
/// paths: it has the full base color, as in renderers. If not `textured`, it is divided by the base color, so
/// that it applies to exit radiance for albedo 1.
Scattering seen_scattering(const Surfaces& surfaces, const SurfacePoint& point, bool textured);

} // namespace prt
