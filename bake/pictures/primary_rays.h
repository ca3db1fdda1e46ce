#pragma once

// What a camera sees along the ray through a pixel, front to back.

#include "prt/picture.h"
#include "prt/ray_scene.h"

namespace prt {

/// A surface that a primary ray meets from the side that it shows.
struct SeenSurface {
    std::uint32_t triangle;
    glm::uvec3 receivers;   ///< at the corners of the triangle
    glm::vec2 barycentrics; ///< of corners 1 and 2
    glm::vec4 base;         ///< base color, linear, and how much of the ray ends here; 1 unless `textured`
    glm::vec3 emission{0};  ///< radiance that it gives off
};

/// Rays through the middles of columns() x rows() rectangles of the picture. Thread-safe.
class PrimaryRays {
public:
    /// Keeps references to both. `rays` was built from `*picture.scene`.
    PrimaryRays(const Picture& picture, const RayScene& rays, int columns, int rows);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    /// Not unit.
    glm::vec3 direction(double x, double y) const;
    /// Of a rectangle.
    float solid_angle(int x, int y) const;

    /// Calls `visit(SeenSurface, transmittance)` for what is met until something opaque is; returns what is
    /// left for the background.
    template <class Visit>
    float walk(int x, int y, Visit&& visit) const {
        const glm::vec3 along = direction(x, y);
        float transmittance = 1, from = 0;
        SeenSurface surface;
        while (transmittance > 0 && next(along, x, y, from, surface)) {
            visit(surface, transmittance);
            transmittance *= 1 - surface.base.a;
        }
        return transmittance;
    }

private:
    /// The nearest surface beyond `from`, which becomes its distance. Culled and cut-out ones do not count,
    /// so that what lies at the same place shows.
    bool next(const glm::vec3& along, int x, int y, float& from, SeenSurface& surface) const;
    /// Base alpha 0 where the surface is culled or cut out.
    SeenSurface surface_at(unsigned id, const glm::vec3& along, int x, int y) const;

    const Picture& picture_;
    const RayScene& rays_;
    CameraFrame frame_;
    int columns_, rows_;
};

} // namespace prt
