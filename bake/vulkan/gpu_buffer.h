#pragma once

// Memory that shaders and the processor share or hand over.

#include "vulkan/vulkan_device.h"

#include <cstddef>
#include <span>

namespace prt {

enum class GpuMemory {
    device,   ///< shaders alone
    upload,   ///< the processor writes
    download, ///< the processor reads
};

/// A buffer with its own memory.
class GpuBuffer {
public:
    GpuBuffer() = default;
    /// Of at least 4 bytes. Throws `GpuMemoryError` where that much is not there, or more than a buffer may
    /// have: `what` it holds.
    GpuBuffer(const VulkanDevice& device, std::size_t bytes, GpuMemory memory, const char* what,
              vk::BufferUsageFlags usage = {});

    std::size_t bytes() const { return bytes_; }
    vk::Buffer handle() const { return *buffer_; }
    /// Where the processor finds it; not of `device` memory.
    std::byte* data() const { return data_; }
    template <class T>
    std::span<T> as() const {
        return {reinterpret_cast<T*>(data_), bytes_ / sizeof(T)};
    }
    /// For hierarchies of the device.
    vk::DeviceAddress address(const VulkanDevice& device) const;

private:
    vk::raii::DeviceMemory memory_ = nullptr; // outlives the buffer
    vk::raii::Buffer buffer_ = nullptr;
    std::byte* data_ = nullptr;
    std::size_t bytes_ = 0;
};

} // namespace prt
