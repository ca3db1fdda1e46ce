#pragma once

// Where probes are measured: a little off the surfaces that their corners lie on, to their fronts.

#include "prt/trace_scene.h"
#include "volume/probe_tracer.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// The corners of `cells`, or places at most 0.3 cells away, metres.
std::vector<glm::vec3> free_places(const TraceScene& scene, std::span<const ProbeCell> cells, int threads);

} // namespace prt
