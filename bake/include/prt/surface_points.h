#pragma once

// Points between the vertices of a scene, for measuring errors over the surface. Experimental.

#include "prt/receivers.h"
#include "prt/support/progress.h"
#include "prt/trace_scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// Settings of `surface_points`.
struct SurfacePointOptions {
    std::size_t count = 1024; ///< approximate number of points
    std::uint64_t seed = 0x2545f4914f6cdd1d;
    int threads = 0; ///< number of threads; 0: all
};

/// Points on the front sides of all surfaces of a scene, distributed evenly by area. Points inside geometry,
/// where no light arrives, cut-out points and triangles with a corner without a normal are excluded. Arrays
/// are parallel.
struct SurfacePoints {
    Receivers receivers; ///< the points as receivers; their areas are the areas that they represent
    std::vector<std::uint32_t> triangles; ///< index in the order of the scene's primitives and their
                                          ///< triangles
    std::vector<glm::vec2> uv;            ///< barycentric coordinates of corners 1 and 2
    std::vector<glm::uvec3> corners;      ///< receivers of the scene at the corners of the triangle

    std::size_t size() const { return triangles.size(); }
    /// Returns the barycentric coordinates of all three corners.
    std::array<float, 3> shares(std::size_t point) const {
        return {1 - uv[point].x - uv[point].y, uv[point].x, uv[point].y};
    }
};

/// Chooses points on `scene`. Traces 64 rays per point to find those inside geometry, and 1 024 rays for
/// points that look dark. Throws `Cancelled` after a stop request.
SurfacePoints surface_points(const TraceScene& scene, const SurfacePointOptions& options = {},
                             const Progress& progress = {});

/// Corners of the smaller triangles that contain the points if every triangle is split into quarters at the
/// midpoints of its edges.
struct QuarterCorners {
    SurfacePoints corners; ///< three corners for each point
    /// [points] barycentric coordinates of the point with respect to these corners.
    std::vector<std::array<float, 3>> shares;
};

/// Finds the quarter of the triangle that contains each point.
QuarterCorners quarter_corners(const TraceScene& scene, const SurfacePoints& points);

/// Returns about `count` of the points, selected evenly by area; they represent the full area.
SurfacePoints some_of(const SurfacePoints& points, std::size_t count);

/// Interpolates `at_receivers` [receivers of the scene] at the points, as a renderer does: [points].
std::vector<glm::vec3> interpolated(const SurfacePoints& points, std::span<const glm::vec3> at_receivers);

} // namespace prt
