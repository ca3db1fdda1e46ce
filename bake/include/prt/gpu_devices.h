#pragma once

#include <span>
#include <string>
#include <vector>

namespace prt {

/// Method by which a GPU finds the surfaces that rays hit.
enum class Traversal {
    automatic, ///< ray queries if the device supports them, otherwise `compute`
    device,    ///< ray queries of the device
    compute,   ///< our own hierarchy in compute shaders
};

/// A device that a bake may run on.
struct GpuDevice {
    std::string name;         ///< name reported by the driver
    std::string driver;       ///< driver and its version
    bool hardware = false;    ///< false for a device that is emulated on the CPU
    bool ray_queries = false; ///< supports ray queries
    double memory = 0;        ///< device memory in bytes
    std::string missing_feature =
        {}; ///< feature that a bake needs and the device lacks; empty if it has all of them
};

/// Returns all devices in the order of their numbers; empty if Vulkan is not available.
std::vector<GpuDevice> gpu_devices();

/// Returns the index of a device by its number or part of its name, in any case. Throws `Error` with the
/// available devices unless exactly one matches.
std::size_t named_device(std::span<const GpuDevice> devices, const std::string& which);

} // namespace prt
