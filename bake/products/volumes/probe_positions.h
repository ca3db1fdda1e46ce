#pragma once

// Positions at which probes are measured: slightly off the surfaces at their corners, on the front side.

#include "bake/products/volumes/probe_tracer.h"
#include "bake/scene/trace_scene.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace prt {

/// Returns the corners of `cells`, moved by at most 0.3 cells, metres.
std::vector<glm::vec3> free_positions(const TraceScene& scene, std::span<const ProbeCell> cells, int threads);

} // namespace prt
