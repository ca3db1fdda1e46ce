#pragma once

// Settings that select a tracer.

#include "prt/baked_transfer.h"
#include "prt/falloff.h"

#include <string>

namespace prt {

/// Method by which a GPU finds the surfaces that rays hit.
enum class Traversal {
    automatic, ///< `device` if the GPU supports ray queries, otherwise `compute`
    device,    ///< ray queries of Vulkan: the driver builds and searches the hierarchy of triangles; an error
               ///< with Backend::gpu if the GPU does not support ray queries
    compute,   ///< compute shaders of prtkit search a hierarchy of triangles that prtkit builds
};

/// Settings that select a tracer.
struct TracerChoice {
    Backend backend = Backend::automatic;  ///< hardware that traces rays or draws depth maps
    BakeMethod method = BakeMethod::trace; ///< ray tracing, or depth maps with OpenGL 4.5: on a hardware GPU
                                           ///< for Backend::automatic, on any device for Backend::gpu; `bake`
                                           ///< throws `Error` for Backend::cpu
    int raster_resolution = 1024;          ///< texels along each side of a depth map, 16..16384; ignored by
                                           ///< BakeMethod::trace
    /// GPU that traces rays with Backend::gpu: its index in gpu_devices(), or a part of its name, as in
    /// `named_device`; empty: the best device. Other backends and depth maps ignore this member.
    std::string gpu = {};
    /// Method by which a GPU traces rays. The CPU and depth maps ignore this member.
    Traversal traversal = Traversal::automatic;
    /// Distance fall-off of occlusion; the default blocks all light at every distance. Depth maps ignore this
    /// member, and `bake` throws `Error` for another fall-off with depth maps or with bounces.
    Falloff falloff = {};
};

} // namespace prt
