#pragma once

// Surfaces as pictures light them: by the normals of their corners, where the triangle itself is not turned
// away.

#include "prt/ray_scene.h"
#include "prt/surfaces.h"

#include <glm/geometric.hpp>

namespace prt {

/// One side of a triangle at a point of it. Normals are unit and point to that side.
struct LitSide {
    glm::vec3 position, face, normal; ///< `normal` is interpolated between the corners
    float offset;                     ///< RayScene::triangle_offset

    LitSide other() const { return {position, -face, -normal, offset}; }
    /// Whether light from there arrives: none from behind the triangle, whose shadow the point lies in,
    /// though the interpolated normal may look that way, and none from behind that normal.
    bool faces(const glm::vec3& towards) const {
        return glm::dot(normal, towards) > 0 && glm::dot(face, towards) > 0;
    }
    /// Where rays start.
    glm::vec3 origin() const { return position + face * offset; }
};

/// A point of a triangle as a ray has met it: from its barycentric coordinates, as the length of a ray rounds
/// more.
struct MetSurface {
    LitSide side; ///< that the ray came from
    bool back;    ///< of the triangle
};

MetSurface met_surface(const Scene& scene, const RayScene& rays, const SurfacePoint& point,
                       const glm::vec3& along);

/// What a camera sees of a surface, which need not be what light sees of it: all of its base color, as
/// renderers multiply by it. Not `textured`: over that, so that it belongs to exit radiance for albedo 1.
Scattering seen_scattering(const Surfaces& surfaces, const SurfacePoint& point, bool textured);

} // namespace prt
