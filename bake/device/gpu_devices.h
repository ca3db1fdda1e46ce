#pragma once

// Lists the GPUs that can run a bake, and selects one of them by number or name.

#include <span>
#include <string>
#include <vector>

namespace prt {

/// A Vulkan device.
struct GpuDevice {
    std::string name;      ///< name that the driver reports
    std::string driver;    ///< name and version of the driver; empty if the device is older than Vulkan 1.2
    bool hardware = false; ///< false: the CPU emulates the device
    bool ray_queries = false; ///< true: the device supports Traversal::device
    double memory = 0;        ///< size of the largest heap of device memory in bytes
    /// First feature that a bake needs and the device lacks; empty if the device can run a bake.
    std::string missing_feature = {};
};

/// Returns all Vulkan devices, including devices that cannot run a bake. The index of a device is its number
/// for `named_device`. The result is empty if Vulkan is not available or reports an error.
std::vector<GpuDevice> gpu_devices();

/// Returns the index in `devices` of the device that `which` selects: a decimal index, or a part of the
/// device's name without regard to case. A valid index has priority. Throws `Error` with a list of `devices`
/// unless `which` is a valid index or a part of exactly one name.
std::size_t named_device(std::span<const GpuDevice> devices, const std::string& which);

} // namespace prt
