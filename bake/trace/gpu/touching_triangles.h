#pragma once

// What touches receivers: blockers at distance zero, which depth maps cannot tell from the receiver's own
// surface at any resolution.

#include "prt/trace_scene.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

struct TouchingTriangles {
    std::vector<glm::uvec2> ranges; ///< [indices] first triangle and one past the last
    std::vector<glm::vec4> corners; ///< [triangles][3] seen from the start of the receiver's rays
};

/// Opaque triangles that touch receivers[indices[i]] and that can block what it sees; faces nearly flush with
/// it (within 8 degrees) are left out, as they hide at most half a percent of its light.
TouchingTriangles touching_triangles(const TraceScene& scene, const Receivers& receivers,
                                     std::span<const std::uint32_t> indices);

} // namespace prt
