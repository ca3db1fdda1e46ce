#pragma once

#include "prt/trace_scene.h"
#include "prt/tracer.h"

#include <memory>

namespace prt {

/// Which tracer to use.
struct TracerChoice {
    Backend backend = Backend::automatic;
    BakeMethod method = BakeMethod::trace;
    int raster_resolution = 1024; ///< texels along each side of a depth map
};

/// The tracer that `choice` asks for: on a hardware GPU where the backend is automatic and there is one.
/// Keeps a reference to `scene`. Throws `Error` where the backend is not there.
std::unique_ptr<Tracer> make_tracer(const TraceScene& scene, const TracerChoice& choice = {});

} // namespace prt
