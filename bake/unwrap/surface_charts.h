#pragma once

// Cuts surfaces into pieces that a projection along an axis lays flat.

#include "prt/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// A triangle to be laid flat.
struct ChartFace {
    std::size_t primitive = 0, triangle = 0; ///< in the scene
    glm::dvec3 corners[3];
    glm::dvec3 normal{0}; ///< unit, zero where there is no area beyond rounding
};

struct SurfaceChart {
    int axis = 0; ///< x, y, z, along or against which it is seen: in front or behind
    std::vector<std::uint32_t> faces;
};

/// Where a place lies, seen along that axis: metres.
glm::dvec2 projected(const glm::dvec3& position, int axis);

std::vector<ChartFace> chart_faces(const Scene& scene, std::span<const std::size_t> primitives);

/// Every face is in one chart. Within one, faces hang together by edges that are not sharp, look to one side,
/// and lie beside each other where they are projected. Faces without area are in charts of others, behind
/// these, unless there are no others. Stops where there are more than `max_charts`: some may overlap then.
std::vector<SurfaceChart> cut_into_charts(const Scene& scene, std::span<const ChartFace> faces,
                                          std::size_t max_charts);

} // namespace prt
