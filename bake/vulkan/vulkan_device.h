#pragma once

// A Vulkan 1.2 device, chosen, with one queue that computes.

#include "prt/gpu_devices.h"
#include "prt/gpu_failure.h"
#include "prt/support/error.h"

#include <vulkan/vulkan_raii.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace prt {

/// Which device, and what of it.
struct VulkanChoice {
    std::string device = {}; ///< a number, or part of a name; empty: the best
    bool hardware_only = false;
    Traversal traversal = Traversal::automatic;
    bool validate = false; ///< every call, by the layer for that: see complaints()
};

/// Whether this machine can have a hardware GPU: on Linux all have a file in /dev. Quick, where asking
/// drivers takes a quarter of a second and what software ones load.
bool may_have_hardware();

/// Stays where it is.
class VulkanDevice {
public:
    /// Throws `Error` that says why where there is no such device.
    explicit VulkanDevice(const VulkanChoice& choice);
    VulkanDevice(const VulkanDevice&) = delete;
    VulkanDevice& operator=(const VulkanDevice&) = delete;

    struct Traits {
        GpuDevice about;
        bool ray_queries = false;          ///< those that are used
        std::size_t most_bytes = 0;        ///< of a buffer
        std::uint32_t least_subgroup = 0;  ///< threads, at least
        double clock_seconds = 0;          ///< of a step of the device's clock; 0: it has none
        std::uint32_t clock_bits = 0;      ///< after which it begins anew
        std::size_t scratch_alignment = 1; ///< where memory to build hierarchies in begins
        std::uint32_t most_groups = 65535; ///< of a dispatch, in x
        std::uint64_t most_instances = 0, most_triangles = 0; ///< of a hierarchy of the device
    };
    const Traits& traits() const { return traits_; }
    const vk::raii::Device& handle() const { return device_; }
    const vk::raii::Queue& queue() const { return queue_; }
    std::uint32_t queue_family() const { return family_; }
    /// A kind of memory among `kinds` (a bit each) that has all of `wanted`. Throws `Error` where none has.
    std::uint32_t memory_kind(std::uint32_t kinds, vk::MemoryPropertyFlags wanted) const;
    /// What the validation layer said, a line each.
    const std::vector<std::string>& complaints() const { return *complaints_; }

private:
    void make_instance(bool validate);
    void make_device();

    vk::raii::Context context_;
    std::unique_ptr<std::vector<std::string>> complaints_;
    vk::raii::Instance instance_ = nullptr;
    vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
    vk::raii::PhysicalDevice physical_ = nullptr;
    vk::raii::Device device_ = nullptr;
    vk::raii::Queue queue_ = nullptr;
    std::uint32_t family_ = 0;
    Traits traits_;
};

/// Runs `work`, and says what a driver complains of as `Error`: `GpuLost` and `GpuMemoryError` where it is
/// that.
template <class Work>
auto with_vulkan_errors(const Work& work) {
    try {
        return work();
    } catch (const vk::DeviceLostError&) {
        throw GpuLost("the GPU was lost while it worked: its driver was reset, or it was taken away");
    } catch (const vk::OutOfDeviceMemoryError&) {
        throw GpuMemoryError("the GPU has not enough memory");
    } catch (const vk::OutOfHostMemoryError&) {
        throw GpuMemoryError("there is not enough memory for the GPU's driver");
    } catch (const vk::SystemError& error) {
        throw Error("the GPU's driver refuses: " + one_line(error.what()));
    }
}

} // namespace prt
