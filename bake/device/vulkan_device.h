#pragma once

// Opens a Vulkan 1.2 device with one compute queue.

#include "bake/device/gpu_devices.h"
#include "bake/device/gpu_failure.h"
#include "prt/bake/bake_options.h"
#include "prt/core/error.h"

#include <vulkan/vulkan_raii.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace prt {

/// Selects a device and its features.
struct VulkanChoice {
    std::string device = {}; ///< a number, or part of a name; empty: the best
    bool hardware_only = false;
    Traversal traversal = Traversal::automatic;
    bool validate = false; ///< validate every call with the validation layer; see complaints()
};

/// Whether this machine can have a hardware GPU: on Linux all of them have a file in /dev. This is fast,
/// whereas querying drivers takes a quarter of a second, and software drivers load large libraries.
bool may_have_hardware();

/// An opened device. It cannot be moved.
class VulkanDevice {
public:
    /// Throws `Error` with the reason if there is no such device.
    explicit VulkanDevice(const VulkanChoice& choice);
    VulkanDevice(const VulkanDevice&) = delete;
    VulkanDevice& operator=(const VulkanDevice&) = delete;

    struct Traits {
        GpuDevice about;
        bool ray_queries = false;          ///< ray queries are used
        std::size_t max_bytes = 0;         ///< maximum bytes of a buffer
        std::uint32_t min_subgroup = 0;    ///< minimum number of threads of a subgroup
        double clock_seconds = 0;          ///< seconds per tick of the device's clock; 0: it has no clock
        std::uint32_t clock_bits = 0;      ///< bits after which the clock wraps around
        std::size_t scratch_alignment = 1; ///< alignment of scratch memory for building hierarchies
        std::uint32_t max_groups = 65535;  ///< maximum workgroups of a dispatch in x
        std::uint64_t max_instances = 0, max_triangles = 0; ///< limits of a hierarchy of the device
    };
    const Traits& traits() const { return traits_; }
    const vk::raii::Device& handle() const { return device_; }
    const vk::raii::Queue& queue() const { return queue_; }
    std::uint32_t queue_family() const { return family_; }
    /// Returns a memory type among `kinds` (one bit each) that has all of `wanted`. Throws `Error` if no
    /// type matches.
    std::uint32_t memory_kind(std::uint32_t kinds, vk::MemoryPropertyFlags wanted) const;
    /// Messages of the validation layer, one line each.
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

/// Runs `work`, and converts Vulkan exceptions to `Error`, or to `GpuLost` and `GpuMemoryError` in these
/// cases.
template <class Work>
auto with_vulkan_errors(const Work& work) {
    try {
        return work();
    } catch (const vk::DeviceLostError&) {
        throw GpuLost("the GPU was lost during the work: its driver was reset, or the device was removed");
    } catch (const vk::OutOfDeviceMemoryError&) {
        throw GpuMemoryError("the GPU does not have enough memory");
    } catch (const vk::OutOfHostMemoryError&) {
        throw GpuMemoryError("there is not enough memory for the GPU's driver");
    } catch (const vk::SystemError& error) {
        throw Error("the GPU's driver reports an error: " + one_line(error.what()));
    }
}

} // namespace prt
