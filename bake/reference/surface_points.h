#pragma once

// Points between the vertices of a scene, for measuring errors over the surface. Experimental.

#include "bake/scene/receivers.h"
#include "bake/scene/trace_scene.h"
#include "prt/core/progress.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Settings of `surface_points`.
struct SurfacePointOptions {
    /// Approximate number of points before some are excluded (see `SurfacePoints`); the result may have
    /// fewer.
    std::size_t count = 1024;
    std::uint64_t seed = 0x2545f4914f6cdd1d; ///< seed of the positions, and of the rays that test them
    int threads = 0; ///< currently not used: the number of threads is that of the TraceScene
};

/// Points on the front sides of all surfaces of a scene, distributed evenly by area. Excluded are points
/// inside geometry, where no light arrives, points at which the coverage of the surface is 0 (such as holes
/// of cut-outs), and triangles with a corner whose normal is zero. Every array has one entry per point, at
/// the index of the point.
struct SurfacePoints {
    /// [points] the points as receivers. The area is that of the part of the surface which the point
    /// represents, in m², times the coverage of the surface at the point (Surfaces::coverage).
    Receivers receivers;
    std::vector<std::uint32_t> triangles; ///< [points] triangle of the point: index among the triangles of
                                          ///< all primitives, in the order of Scene::primitives
    std::vector<glm::vec2> uv;            ///< [points] barycentric coordinates for corners 1 and 2 of the
                                          ///< triangle, 0..1
    std::vector<glm::uvec3> corners;      ///< [points] vertices at corners 0, 1 and 2 of the triangle, as
                                          ///< indices of the scene's receivers

    std::size_t size() const { return triangles.size(); }
    /// Returns the barycentric coordinates of `point` for corners 0, 1 and 2 of its triangle; their sum is 1.
    std::array<float, 3> shares(std::size_t point) const {
        return {1 - uv[point].x - uv[point].y, uv[point].x, uv[point].y};
    }
};

/// Chooses points on the surfaces of `scene`. Finds points inside geometry by 64 rays per point, and by more
/// rays from points where all of them are blocked. Throws the errors of TraceScene::rays, and `Cancelled`
/// after a stop request.
SurfacePoints surface_points(const TraceScene& scene, const SurfacePointOptions& options = {},
                             const Progress& progress = {});

/// Result of `quarter_corners`: the corners of the quarter triangle that contains each point.
struct QuarterCorners {
    /// [3 · points] the corners of the quarter of point p are the entries 3 p, 3 p + 1 and 3 p + 2. Each has
    /// its own position and `uv`, and the triangle, normal and area of point p.
    SurfacePoints corners;
    /// [points][3] barycentric coordinates of the point with respect to the three corners of its quarter.
    std::vector<std::array<float, 3>> shares;
};

/// Splits every triangle that contains a point into four quarters at the midpoints of its edges, and returns
/// the corners of the quarter that contains the point, for each of `points`. `points` must be on `scene`.
QuarterCorners quarter_corners(const TraceScene& scene, const SurfacePoints& points);

/// Returns about `count` of `points`, selected evenly by area. Their areas are scaled so that they represent
/// the same total area as all of `points`.
SurfacePoints some_of(const SurfacePoints& points, std::size_t count);

/// Returns the values at `points`, [points], interpolated linearly between the values at the corners of each
/// triangle. `at_receivers`: values at the vertices, [receivers of the scene].
std::vector<glm::vec3> interpolated(const SurfacePoints& points, std::span<const glm::vec3> at_receivers);

} // namespace prt
