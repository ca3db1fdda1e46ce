#pragma once

// Visible surfaces along the ray through a pixel, front to back.

#include "bake/scene/ray_scene.h"
#include "prt/render/picture.h"

namespace prt {

/// A surface that a primary ray hits on a visible side.
struct SeenSurface {
    std::uint32_t triangle;
    glm::uvec3 receivers;   ///< receivers at the corners of the triangle
    glm::vec2 barycentrics; ///< coordinates of corners 1 and 2
    glm::vec4 base;         ///< linear base color, and the share of the ray that ends here; 1 unless
                            ///< `textured`
    glm::vec3 emission{0};  ///< emitted radiance
};

/// Rays through the centers of columns() x rows() rectangles of the picture. Thread-safe.
class PrimaryRays {
public:
    /// Keeps references to both. `rays` was built from `*picture.scene`.
    PrimaryRays(const Picture& picture, const RayScene& rays, int columns, int rows);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    /// Direction of the ray, not unit.
    glm::vec3 direction(double x, double y) const;
    /// Solid angle of a rectangle.
    float solid_angle(int x, int y) const;

    /// Calls `visit(SeenSurface, transmittance)` for each surface up to the first opaque one; returns the
    /// transmittance that is left for the background.
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
    /// Finds the nearest surface beyond `from`, and sets `from` to its distance. Culled and cut-out surfaces
    /// are skipped, so that other surfaces at the same position are visible.
    bool next(const glm::vec3& along, int x, int y, float& from, SeenSurface& surface) const;
    /// Returns the surface; its base alpha is 0 if it is culled or cut out.
    SeenSurface surface_at(unsigned id, const glm::vec3& along, int x, int y) const;

    const Picture& picture_;
    const RayScene& rays_;
    CameraFrame frame_;
    int columns_, rows_;
};

} // namespace prt
