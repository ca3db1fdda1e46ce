#pragma once

// Light of lamps on a Vulkan device.

#include "bake/device/gpu_queue.h"
#include "bake/trace/lamp_light.h"
#include "bake/trace_gpu/gpu_scene.h"

namespace prt {

/// Computes the same as lamp_light_on_cpu in a compute shader. Work is submitted in pieces of about a
/// twentieth of a second, according to the measured speed. Throws `Error` if the lamps do not fit into the
/// device's memory, and `Cancelled` when asked to stop.
LampLight lamp_light_on_gpu(const VulkanDevice& device, GpuQueue& queue, const GpuScene& scene,
                            const LampTask& task, const Progress& progress);

} // namespace prt
