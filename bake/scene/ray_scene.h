#pragma once

// Ray queries against the triangles of a scene on the CPU, with Embree.

#include "bake/scene/receivers.h"
#include "prt/load/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

struct RTCDeviceTy;
struct RTCSceneTy;

namespace prt {

class OppositeTriangles;

/// A segment of a ray: the points origin + t direction for t from `from` to `to`.
struct Ray {
    glm::vec3 origin, ///< metres, relative to Scene::origin
        direction;    ///< any length greater than 0
    float from = 0;   ///< begin of the segment, in lengths of `direction`; at least 0
    /// End of the segment, in lengths of `direction`. The default is infinity: the ray has no end.
    float to = std::numeric_limits<float>::infinity();
};

/// Hit of a ray of a receiver on a surface.
struct Hit {
    std::uint32_t triangle; ///< index among the triangles of all primitives, in the order of
                            ///< Scene::primitives
    float u, v;             ///< barycentric coordinates of the hit for corners 1 and 2, 0..1
    /// Number of rays that the hit represents, greater than 0. It can be a fraction, because a surface may
    /// stop a share of a ray, and because some hits may represent all blocked rays
    /// (TraceOptions::hit_stride). The sum over all hits of a receiver is its number of blocked rays.
    float weight;
    float footprint; ///< area of the surface that the hit represents, m², for filters of textures; 0 if
                     ///< SurfaceTraits::textured is false
    bool back;       ///< true: the ray hit the back of the triangle
};

/// Hit of a ray on a triangle.
struct RayHit {
    unsigned triangle; ///< index among the triangles of all primitives, in the order of Scene::primitives
    glm::vec2 uv;      ///< barycentric coordinates of the hit for corners 1 and 2 of the triangle, 0..1
    float distance;    ///< distance from the ray's origin, in lengths of the ray's direction
};

/// Finds hits of rays on the triangles of a scene, with a bounding volume hierarchy. Both sides of a triangle
/// are hit, and textures are ignored. Rays pass materials with `casts_shadow` false. A triangle id is the
/// index of a triangle as in RayHit::triangle. Const functions are thread-safe.
class RayScene {
public:
    /// Builds the hierarchy with `threads` threads (0: all hardware threads). Copies positions and triangles;
    /// keeps no reference to `scene`. Throws `Error` if Embree cannot be started or memory runs out.
    explicit RayScene(const Scene& scene, int threads = 0);
    RayScene(RayScene&&) noexcept;
    ~RayScene();

    /// Returns the nearest hit along `ray`, or no value if the ray hits nothing. If the hit triangle is one
    /// of a pair of opposite triangles (see `opposites`), the hit is on the triangle whose front faces the
    /// origin of the ray.
    std::optional<RayHit> nearest(const Ray& ray) const;
    /// Returns the nearest hit on an accepted triangle, or no value without such a hit. The ray passes all
    /// other triangles. `accepts` gets a triangle id and returns true to accept it; it is called during the
    /// query, on the calling thread. If the hit triangle is one of a pair of opposite triangles (see
    /// `opposites`), the hit may be on its back.
    std::optional<RayHit> nearest(const Ray& ray,
                                  const std::function<bool(unsigned triangle)>& accepts) const;
    /// Returns whether `ray` hits any triangle.
    bool occluded(const Ray& ray) const;

    /// Returns the pairs of triangles of one vertex array that have the same corner positions in opposite
    /// order. The materials of both are single-sided and cast shadows. A direct query of `handle()` may
    /// report a hit on the back of one triangle of a pair. The caller must then replace the hit by a hit on
    /// the front of the other triangle (OppositeTriangles::shown, an internal function). The function
    /// `nearest(ray)` does so itself.
    const OppositeTriangles& opposites() const { return *opposites_; }

    /// Returns whether rays can hit triangle `id`. They pass triangles of materials with `casts_shadow`
    /// false, and triangles that an opposite one stands for (OppositeTriangles::traced).
    bool is_traced(unsigned id) const { return corners_[id].x != corners_[id].y; }

    /// Returns the RTCScene of Embree, for queries of several rays at once. This object owns it.
    RTCSceneTy* handle() const { return scene_.get(); }

    /// Returns the distance in metres by which a ray's origin must be moved off the surface at `position` so
    /// that the surface does not block the ray: 2^-24 (12 c + 16 l). Here c is the largest magnitude of a
    /// coordinate of `position`, and l is the largest distance on one axis from `position` to a corner of any
    /// triangle whose bounding box contains `position`, with a tolerance of 1e-6 c (docs/math.md, section 2).
    float surface_offset(const glm::vec3& position) const;
    /// Returns the part of `surface_offset` that does not depend on triangles, in metres: 2^-24 · 12 c, with
    /// c the largest magnitude of a coordinate of `position`.
    static float coordinate_offset(const glm::vec3& position);

    /// Returns an upper bound, in metres, of the `surface_offset` that points of triangle `id` would have if
    /// the scene contained only this triangle. Therefore it is fast, but can be less than `surface_offset`
    /// next to a larger triangle. `distance`: length in metres of a ray that ends on the triangle, which
    /// increases the bound; 0 for a ray that starts there.
    float triangle_offset(unsigned id, float distance = 0) const;

    /// Replaces the contents of `ids` by the ids of all triangles whose bounding boxes are within `distance`
    /// metres of `position`. `ids` may contain a few more triangles, which are farther away.
    void triangles_near(const glm::vec3& position, float distance, std::vector<unsigned>& ids) const;

    /// Returns the origin of the rays of receiver `index` in metres: the position of the receiver plus
    /// `surface_offset` times Receivers::starts (or times the normal if `starts` is empty). If this point is
    /// on another surface, for example on a wall that rises from a floor, the origin is in front of that
    /// surface.
    glm::vec3 ray_origin(const Receivers& receivers, std::uint32_t index) const;

    /// Location of a triangle in a scene.
    struct Triangle {
        std::uint32_t primitive, ///< index into Scene::primitives
            triangle;            ///< index into Primitive::triangles of this primitive
    };
    /// Returns the location in the scene of the triangle with the id `id`.
    Triangle triangle(unsigned id) const { return triangles_[id]; }

private:
    /// Offset in units that moves `start` (in units from `position`) off all surfaces; zero if it is on no
    /// surface.
    glm::vec3 way_off_surfaces(const glm::vec3& position, const glm::vec3& start, float unit) const;
    /// Whether the box of triangle `id` is within `distance` of `position` on every axis.
    bool triangle_reaches(unsigned id, const glm::vec3& position, float distance) const;
    /// Visits all triangles whose boxes are within `distance`, and others that share leaves of the tree with
    /// them.
    template <class Visit>
    void visit_near(const glm::vec3& position, float distance, Visit&& visit) const;

    struct Release {
        void operator()(RTCDeviceTy* device) const;
        void operator()(RTCSceneTy* scene) const;
    };
    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
    const glm::vec3* positions_ = nullptr; ///< Embree's copies: [vertices], [triangles]
    const glm::uvec3* corners_ = nullptr;
    std::vector<Triangle> triangles_;
    std::unique_ptr<const OppositeTriangles> opposites_;
};

} // namespace prt
