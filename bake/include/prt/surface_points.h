#pragma once

// Points between the vertices of a scene for measuring errors that are visible in a picture. Experimental.

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

struct SurfacePointOptions {
    std::size_t count = 1024; ///< approximate number of points
    std::uint64_t seed = 0x2545f4914f6cdd1d;
    int threads = 0; ///< number of threads; 0: all
};

/// Points spread by area over the fronts of all surfaces of a scene. Points inside geometry, where no light
/// arrives, cut-out points and triangles with a corner without a normal are excluded. Arrays are parallel.
struct SurfacePoints {
    Receivers receivers;                  ///< positions of the points; their areas are the areas that they
                                          ///< represent
    std::vector<std::uint32_t> triangles; ///< index in the order of the scene's primitives and their
                                          ///< triangles
    std::vector<glm::vec2> uv;            ///< barycentric coordinates of corners 1 and 2
    std::vector<glm::uvec3> corners;      ///< receivers of the scene at the corners of the triangle

    std::size_t size() const { return triangles.size(); }
    /// Barycentric coordinates of all three corners.
    std::array<float, 3> shares(std::size_t point) const {
        return {1 - uv[point].x - uv[point].y, uv[point].x, uv[point].y};
    }
};

/// Chooses the points. Cost: 64 rays per point, and 1 024 rays from points that look dark. Throws
/// `Cancelled`.
SurfacePoints surface_points(const TraceScene& scene, const SurfacePointOptions& options = {},
                             const Progress& progress = {});

/// Corners of the triangles that contain the points if every triangle is split at the midpoints of its edges.
struct QuarterCorners {
    SurfacePoints corners;                    ///< three corners for each point
    std::vector<std::array<float, 3>> shares; ///< [points] barycentric coordinates in these three corners
};

/// Finds the quarter of the triangle that contains each point.
QuarterCorners quarter_corners(const TraceScene& scene, const SurfacePoints& points);

/// Selects about `count` points by area, which represent all of them.
SurfacePoints some_of(const SurfacePoints& points, std::size_t count);

/// Interpolates values of the scene's receivers [receivers] at the points, as a renderer does.
std::vector<glm::vec3> interpolated(const SurfacePoints& points, std::span<const glm::vec3> at_receivers);

} // namespace prt
