#pragma once

// Receivers in the layout of shaders.

#include "bake/scene/trace_scene.h"
#include "shared_structs.h"

#include <span>
#include <vector>

namespace prt {

/// Returns receivers[indices] with ray origins and seeds: [indices].
std::vector<gpu::Receiver> gpu_receivers(const TraceScene& scene, const Receivers& receivers,
                                         std::span<const std::uint32_t> indices, std::uint64_t seed);

} // namespace prt
