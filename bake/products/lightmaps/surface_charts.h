#pragma once

// Cuts surfaces into charts, which are projected along an axis.

#include "prt/load/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

/// A triangle of the scene that becomes part of a chart.
struct ChartFace {
    std::size_t primitive = 0, triangle = 0; ///< in the scene
    glm::dvec3 corners[3];
    glm::dvec3 normal{0}; ///< unit; zero for a triangle without area beyond rounding
};

struct SurfaceChart {
    int axis = 0; ///< x, y or z: axis of the projection, in either direction
    std::vector<std::uint32_t> faces;
};

/// Projects a position along `axis`, metres.
glm::dvec2 projected(const glm::dvec3& position, int axis);

std::vector<ChartFace> chart_faces(const Scene& scene, std::span<const std::size_t> primitives);

/// Cuts faces into charts; every face is in one chart. The faces of a chart are connected by edges that are
/// not sharp, face the same side, and do not overlap in the projection. Faces without area are appended to
/// other charts if there are any. Stops if there are more than `max_charts`; some may overlap then.
std::vector<SurfaceChart> cut_into_charts(const Scene& scene, std::span<const ChartFace> faces,
                                          std::size_t max_charts);

} // namespace prt
