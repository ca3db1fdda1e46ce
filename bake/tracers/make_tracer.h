#pragma once

// Creates the object that traces rays, on a GPU or on the CPU.

#include "bake/scene/trace_scene.h"
#include "bake/trace/tracer.h"
#include "prt/bake/bake_options.h"

#include <memory>

namespace prt {

/// Creates the tracer for `choice`. BakeMethod::trace with Backend::automatic traces rays on a hardware GPU
/// with enough memory for the scene if there is one, otherwise on the CPU; if the GPU fails later, the tracer
/// continues on the CPU. With Backend::gpu the tracer throws `GpuFailure` (bake/device/gpu_failure.h) if the
/// GPU fails. BakeMethod::raster needs OpenGL 4.5, with Backend::automatic on hardware; with Backend::cpu the
/// tracer traces rays instead. Depth maps take rays, for hits and lamps, from the tracer that
/// BakeMethod::trace with Backend::automatic gives. The tracer keeps a reference to `scene`. Throws `Error`
/// if the backend is not available or the scene is too large for its GPU, and `GpuMemoryError` if the scene
/// does not fit into the memory of the GPU of Backend::gpu. Does not check TracerChoice::falloff.
std::unique_ptr<Tracer> make_tracer(const TraceScene& scene, const TracerChoice& choice = {});

} // namespace prt
