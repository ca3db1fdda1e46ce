#pragma once

#include "lamps/lamp_light.h"
#include "trace/gpu/gpu_scene.h"

namespace prt {

/// As lamp_light_on_cpu, in a compute shader through the hierarchy of `scene`, whose context must be current.
/// Work goes to the device in pieces of about a tenth of a second, by the speed that was measured. Throws
/// `Error` where the lamps do not fit the device, `Cancelled` when asked to stop.
LampLight lamp_light_on_gpu(const GpuScene& scene, const LampTask& task, const Progress& progress);

} // namespace prt
