#pragma once

// Ray queries against the triangles of a scene on the CPU, with Embree.

#include "prt/receivers.h"
#include "prt/scene.h"

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

/// A ray, or a segment of one.
struct Ray {
    glm::vec3 origin, direction;
    float from = 0; ///< begin and end of the segment, in lengths of `direction`
    float to = std::numeric_limits<float>::infinity();
};

/// Hit of a ray on a triangle.
struct RayHit {
    unsigned triangle; ///< index in the order of the scene's primitives and their triangles
    glm::vec2 uv;      ///< barycentric coordinates of corners 1 and 2
    float distance;    ///< distance in lengths of the ray's direction
};

/// A bounding volume hierarchy over all triangles of a scene. The build uses several threads; queries are
/// thread-safe.
class RayScene {
public:
    /// Copies the required data of `scene`. `threads` build the hierarchy (0: all). Throws `Error` when
    /// memory runs out.
    explicit RayScene(const Scene& scene, int threads = 0);
    RayScene(RayScene&&) noexcept;
    ~RayScene();

    /// Returns the nearest hit along the ray; empty without a hit. For a pair of opposite triangles it
    /// is a hit of the one that faces the ray.
    std::optional<RayHit> nearest(const Ray& ray) const;
    /// Returns the nearest hit of a triangle for which `accepts` returns true; empty without a hit.
    std::optional<RayHit> nearest(const Ray& ray,
                                  const std::function<bool(unsigned triangle)>& accepts) const;
    /// Returns whether the ray hits any triangle.
    bool occluded(const Ray& ray) const;

    /// Pairs of opposite triangles. Code that reads hits from `handle()` must apply them.
    const OppositeTriangles& opposites() const { return *opposites_; }

    /// Embree's RTCScene, for packets of rays.
    RTCSceneTy* handle() const { return scene_.get(); }

    /// Returns the distance by which a ray's origin must be moved off the surface at `position` so that the
    /// surface does not block the ray: 2^-24 (12 c + 16 l). Here c is the largest coordinate of `position`,
    /// and l is the largest distance on one axis to a corner of any triangle that contains `position`
    /// (docs/math.md, section 2).
    float surface_offset(const glm::vec3& position) const;
    /// Returns the first term of `surface_offset`: 2^-24 · 12 c, with c the largest coordinate of `position`.
    static float coordinate_offset(const glm::vec3& position);

    /// Returns a quick upper bound of `surface_offset` for all points of triangle `id`, considering no other
    /// triangle, for a ray of length `distance` that ends there.
    float triangle_offset(unsigned id, float distance = 0) const;

    /// Writes the triangles whose bounding boxes are within `distance` of `position` to `ids`.
    void triangles_near(const glm::vec3& position, float distance, std::vector<unsigned>& ids) const;

    /// Returns the origin of the rays of receivers[index]: its position, moved off the surface by
    /// Receivers::starts. If this point is on another surface, for example on a wall in the middle of a
    /// floor, it is moved to the front of that surface.
    glm::vec3 ray_origin(const Receivers& receivers, std::uint32_t index) const;

    struct Triangle {
        std::uint32_t primitive, triangle; ///< indices into Scene::primitives and its triangles
    };
    /// Returns the primitive of triangle `id` and its index there.
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
