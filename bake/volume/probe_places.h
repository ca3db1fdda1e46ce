#pragma once

// Where probes are measured: a little off the surfaces that their corners lie on, to their fronts.

#include "prt/trace_scene.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// The places themselves, or others at most 0.3 of their `cells` [places] away, metres.
std::vector<glm::vec3> free_places(const TraceScene& scene, std::span<const glm::vec3> places,
                                   std::span<const float> cells, int threads);

} // namespace prt
