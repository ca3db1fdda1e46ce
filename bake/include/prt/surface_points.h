#pragma once

// Points between the vertices of a scene, where errors are measured that a picture shows. Experimental.

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
    std::size_t count = 1024; ///< about so many
    std::uint64_t seed = 0x2545f4914f6cdd1d;
    int threads = 0; ///< 0: all
};

/// Points spread by area over the fronts of all surfaces of a scene, but those that lie inside of geometry,
/// where no light comes, what is cut out, and triangles with a corner that has no normal. Arrays are
/// parallel.
struct SurfacePoints {
    Receivers receivers;                  ///< where they are; their areas are what they stand for
    std::vector<std::uint32_t> triangles; ///< in the order of the scene's primitives and their triangles
    std::vector<glm::vec2> uv;            ///< barycentric coordinates of corners 1 and 2
    std::vector<glm::uvec3> corners;      ///< receivers of the scene

    std::size_t size() const { return triangles.size(); }
    std::array<float, 3> shares(std::size_t point) const {
        return {1 - uv[point].x - uv[point].y, uv[point].x, uv[point].y};
    }
};

/// Time: 64 rays a point, and 1 024 from those that these find dark. Throws `Cancelled` when asked to stop.
SurfacePoints surface_points(const TraceScene& scene, const SurfacePointOptions& options = {},
                             const Progress& progress = {});

/// Where a mesh whose triangles were split at the middles of their edges would have vertices.
struct QuarterCorners {
    SurfacePoints corners;                    ///< three for each point
    std::vector<std::array<float, 3>> shares; ///< [points] of its three
};

/// The quarter of its triangle that each point lies in.
QuarterCorners quarter_corners(const TraceScene& scene, const SurfacePoints& points);

/// About `count` points, by area, which stand for all of them.
SurfacePoints some_of(const SurfacePoints& points, std::size_t count);

/// Values of the scene's receivers [receivers] as a picture shows them at points: interpolated.
std::vector<glm::vec3> interpolated(const SurfacePoints& points, std::span<const glm::vec3> at_receivers);

} // namespace prt
