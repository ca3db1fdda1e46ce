#pragma once

// Creates the object that traces rays, on a GPU or on the CPU.

#include "prt/falloff.h"
#include "prt/gpu_devices.h"
#include "prt/trace_scene.h"
#include "prt/tracer.h"

#include <memory>
#include <string>

namespace prt {

/// Settings that select a tracer.
struct TracerChoice {
    Backend backend = Backend::automatic;  ///< hardware that traces rays
    BakeMethod method = BakeMethod::trace; ///< ray tracing, or depth maps on a GPU with OpenGL 4.5
    int raster_resolution = 1024;          ///< texels along each side of a depth map, 16..16384; ignored by
                                           ///< BakeMethod::trace
    /// GPU that traces rays with Backend::gpu: its index in gpu_devices(), or a part of its name; empty: the
    /// best device. Other backends and depth maps ignore this member.
    std::string gpu = {};
    /// Method by which a GPU traces rays. The CPU and depth maps ignore this member.
    Traversal traversal = Traversal::automatic;
    /// Distance fall-off of occlusion; the default blocks all light at every distance. Depth maps ignore this
    /// member, and `bake` throws `Error` for depth maps with another fall-off.
    Falloff falloff = {};
};

/// Creates the tracer for `choice`. With Backend::automatic rays are traced on a hardware GPU with enough
/// memory for the scene if there is one, otherwise on the CPU; if the GPU fails later, the tracer continues
/// on the CPU. With Backend::gpu the tracer throws `GpuFailure` (prt/gpu_failure.h) if the GPU fails. The
/// tracer keeps a reference to `scene`. Throws `Error` if the backend is not available, and `GpuMemoryError`
/// if the scene does not fit into the memory of the GPU of Backend::gpu.
std::unique_ptr<Tracer> make_tracer(const TraceScene& scene, const TracerChoice& choice = {});

} // namespace prt
