#pragma once

// Ray queries against the triangles of a scene on the CPU, by Embree.

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

struct Ray {
    glm::vec3 origin, direction;
    float from = 0; ///< distance, in lengths of `direction`
    float to = std::numeric_limits<float>::infinity();
};

/// Where a ray meets a triangle.
struct RayHit {
    unsigned triangle; ///< in the order of the scene's primitives and their triangles
    glm::vec2 uv;      ///< barycentric coordinates of corners 1 and 2
    float distance;    ///< in lengths of the ray's direction
};

/// A bounding volume hierarchy over all triangles of a scene. Building is multithreaded; queries are
/// thread-safe.
class RayScene {
public:
    /// Copies what it needs of `scene`. `threads` build it (0: all). Throws `Error` when memory runs out.
    explicit RayScene(const Scene& scene, int threads = 0);
    RayScene(RayScene&&) noexcept;
    ~RayScene();

    /// The nearest triangle along the ray, or nothing. Of a pair of opposite triangles, the one that faces
    /// the ray.
    std::optional<RayHit> nearest(const Ray& ray) const;
    /// The nearest of those triangles that `accepts`.
    std::optional<RayHit> nearest(const Ray& ray,
                                  const std::function<bool(unsigned triangle)>& accepts) const;
    bool occluded(const Ray& ray) const;

    /// Pairs of opposite triangles. Code that reads hits of `handle()` must apply them.
    const OppositeTriangles& opposites() const { return *opposites_; }

    /// An RTCScene, for packets of rays.
    RTCSceneTy* handle() const { return scene_.get(); }

    /// How far to move a ray's origin off the surface at `position` so that the surface does not block it:
    /// 2^-24 (12 c + 16 l), where c is the largest coordinate of `position` and l the largest distance on one
    /// axis to a corner of any triangle that `position` lies on (docs/math.md, section 2).
    float surface_offset(const glm::vec3& position) const;
    /// The first of its terms.
    static float coordinate_offset(const glm::vec3& position);

    /// An upper bound of it for any point of triangle `id` alone, for a ray that ends there after `distance`;
    /// quick.
    float triangle_offset(unsigned id, float distance = 0) const;

    /// Replaces `ids` by the triangles whose boxes come as near as `distance` to `position`.
    void triangles_near(const glm::vec3& position, float distance, std::vector<unsigned>& ids) const;

    /// Where the rays of receivers[index] start: off the surface by Receivers::starts. A start that lies on
    /// another surface, as on a wall that stands in the middle of a floor, moves to the front of it.
    glm::vec3 ray_origin(const Receivers& receivers, std::uint32_t index) const;

    struct Triangle {
        std::uint32_t primitive, triangle; ///< indices into Scene::primitives and its triangles
    };
    /// Where triangle `id` is in the scene.
    Triangle triangle(unsigned id) const { return triangles_[id]; }

private:
    /// In units, zero where `start` (in units from `position`) lies on no surface.
    glm::vec3 way_off_surfaces(const glm::vec3& position, const glm::vec3& start, float unit) const;
    /// Whether the box of triangle `id` comes as near to `position` on every axis.
    bool triangle_reaches(unsigned id, const glm::vec3& position, float distance) const;
    /// All triangles whose boxes come as near, and others that share leaves of the tree with them.
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
