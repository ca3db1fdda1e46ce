#pragma once

#include "prt/falloff.h"
#include "prt/gpu_devices.h"
#include "prt/trace_scene.h"
#include "prt/tracer.h"

#include <memory>
#include <string>

namespace prt {

/// Which tracer to use.
struct TracerChoice {
    Backend backend = Backend::automatic;
    BakeMethod method = BakeMethod::trace;
    int raster_resolution = 1024; ///< texels along each side of a depth map
    /// The GPU to trace on: its number among gpu_devices(), or a part of its name; empty: the best.
    std::string gpu = {};
    Traversal traversal = Traversal::automatic;
    Falloff falloff = {}; ///< of what blocks; for rays alone
};

/// The tracer that `choice` asks for: on a hardware GPU where the backend is automatic and there is one that
/// has room for the scene, and if that is lost on the way the rest on the CPU. Keeps a reference to `scene`.
/// Throws `Error` where the backend is not there.
std::unique_ptr<Tracer> make_tracer(const TraceScene& scene, const TracerChoice& choice = {});

} // namespace prt
