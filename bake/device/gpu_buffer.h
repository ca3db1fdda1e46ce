#pragma once

// Memory that shaders and the CPU share or exchange.

#include "bake/device/vulkan_device.h"

#include <cstddef>
#include <span>

namespace prt {

enum class GpuMemory {
    device,   ///< only shaders access it
    upload,   ///< the CPU writes
    download, ///< the CPU reads
};

/// A buffer with separate memory.
class GpuBuffer {
public:
    GpuBuffer() = default;
    /// Allocates at least 4 bytes. Throws `GpuMemoryError` if too little memory is available, or if a buffer
    /// cannot have this size. `what`: content, for errors.
    GpuBuffer(const VulkanDevice& device, std::size_t bytes, GpuMemory memory, const char* what,
              vk::BufferUsageFlags usage = {});

    std::size_t bytes() const { return bytes_; }
    vk::Buffer handle() const { return *buffer_; }
    /// Address for the CPU; null for `device` memory.
    std::byte* data() const { return data_; }
    template <class T>
    std::span<T> as() const {
        return {reinterpret_cast<T*>(data_), bytes_ / sizeof(T)};
    }
    /// Address for building hierarchies on the device.
    vk::DeviceAddress address(const VulkanDevice& device) const;

private:
    vk::raii::DeviceMemory memory_ = nullptr; // outlives the buffer
    vk::raii::Buffer buffer_ = nullptr;
    std::byte* data_ = nullptr;
    std::size_t bytes_ = 0;
};

} // namespace prt
