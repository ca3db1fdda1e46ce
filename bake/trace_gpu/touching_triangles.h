#pragma once

// Triangles that touch receivers: blockers at distance zero, which depth maps of any resolution cannot
// distinguish from the receiver's own surface.

#include "bake/scene/trace_scene.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

struct TouchingTriangles {
    std::vector<glm::uvec2> ranges; ///< [indices] first triangle and one past the last
    std::vector<glm::vec4> corners; ///< [triangles][3] relative to the origin of the receiver's rays
};

/// Returns opaque triangles that touch receivers[indices[i]] and can block its light. Faces nearly parallel
/// to it (within 8 degrees) are omitted, because they block at most half a percent of its light.
TouchingTriangles touching_triangles(const TraceScene& scene, const Receivers& receivers,
                                     std::span<const std::uint32_t> indices);

} // namespace prt
