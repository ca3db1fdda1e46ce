#pragma once

#include "lamps/lamp_light.h"
#include "trace/gpu/gpu_scene.h"
#include "vulkan/gpu_queue.h"

namespace prt {

/// As lamp_light_on_cpu, in a compute shader. Work goes to the device in pieces of about a twentieth of a
/// second, by the speed that was measured. Throws `Error` where the lamps do not fit the device, `Cancelled`
/// when asked to stop.
LampLight lamp_light_on_gpu(const VulkanDevice& device, GpuQueue& queue, const GpuScene& scene,
                            const LampTask& task, const Progress& progress);

} // namespace prt
