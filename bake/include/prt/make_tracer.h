#pragma once

#include "prt/falloff.h"
#include "prt/gpu_devices.h"
#include "prt/trace_scene.h"
#include "prt/tracer.h"

#include <memory>
#include <string>

namespace prt {

/// Settings that select a tracer.
struct TracerChoice {
    Backend backend = Backend::automatic;
    BakeMethod method = BakeMethod::trace;
    int raster_resolution = 1024; ///< texels along each side of a depth map
    /// GPU to trace on: its index in gpu_devices(), or a part of its name; empty: the best device.
    std::string gpu = {};
    Traversal traversal = Traversal::automatic;
    Falloff falloff = {}; ///< distance fall-off of occlusion; ray tracing only
};

/// Creates the tracer for `choice`. With Backend::automatic it runs on a hardware GPU with enough memory for
/// the scene, if there is one, otherwise on the CPU; if the GPU is lost, it continues on the CPU. Keeps a
/// reference to `scene`. Throws `Error` if the backend is not available.
std::unique_ptr<Tracer> make_tracer(const TraceScene& scene, const TracerChoice& choice = {});

} // namespace prt
