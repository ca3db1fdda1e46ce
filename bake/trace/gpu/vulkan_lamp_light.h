#pragma once

// Light of lamps on a Vulkan device.

#include "lamps/lamp_light.h"
#include "trace/gpu/gpu_scene.h"
#include "vulkan/gpu_queue.h"

namespace prt {

/// Computes the same as lamp_light_on_cpu in a compute shader. Work is submitted in pieces of about a
/// twentieth of a second, according to the measured speed. Throws `Error` if the lamps do not fit into the
/// device's memory, and `Cancelled` when asked to stop.
LampLight lamp_light_on_gpu(const VulkanDevice& device, GpuQueue& queue, const GpuScene& scene,
                            const LampTask& task, const Progress& progress);

} // namespace prt
