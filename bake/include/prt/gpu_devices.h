#pragma once

#include <string>
#include <vector>

namespace prt {

/// How a GPU finds what a ray meets.
enum class Traversal {
    automatic, ///< by its own means where it has some, else by ours
    device,    ///< by its own: ray queries
    compute,   ///< through our hierarchy
};

/// A device that bakes could run on.
struct GpuDevice {
    std::string name;         ///< as its driver calls it
    std::string driver;       ///< with its version
    bool hardware = false;    ///< not a program that computes on the processor
    bool ray_queries = false; ///< traverses triangles by itself
    double memory = 0;        ///< bytes of its own
    std::string lacks = {};   ///< what a bake needs and it has not; empty: nothing
};

/// All of them, in the order of their numbers; nothing where there is no Vulkan.
std::vector<GpuDevice> gpu_devices();

} // namespace prt
