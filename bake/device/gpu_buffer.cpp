// Allocates buffers. They are few and large, so each has separate memory.

#include "bake/device/gpu_buffer.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt {
namespace {

/// Returns the best memory type of the device for a purpose: reading is fast if the memory is cached.
std::uint32_t kind_of(const VulkanDevice& device, std::uint32_t kinds, GpuMemory memory) {
    using Flag = vk::MemoryPropertyFlagBits;
    if (memory == GpuMemory::device)
        return device.memory_kind(kinds, Flag::eDeviceLocal);
    const vk::MemoryPropertyFlags shared = Flag::eHostVisible | Flag::eHostCoherent;
    if (memory == GpuMemory::download) {
        try {
            return device.memory_kind(kinds, shared | Flag::eHostCached);
        } catch (const Error&) { // not all devices have it
        }
    }
    return device.memory_kind(kinds, shared);
}

} // namespace

GpuBuffer::GpuBuffer(const VulkanDevice& device, std::size_t bytes, GpuMemory memory, const char* what,
                     vk::BufferUsageFlags usage)
    : bytes_(std::max<std::size_t>(4, (bytes + 3) / 4 * 4)) {
    if (bytes_ > device.traits().max_bytes)
        throw GpuMemoryError(
            fmt::format("a buffer for {} needs {:.0f} MB, but the limit of \"{}\" is {:.0f} MB", what,
                        static_cast<double>(bytes_) / 1e6, device.traits().about.name,
                        static_cast<double>(device.traits().max_bytes) / 1e6));
    using Use = vk::BufferUsageFlagBits;
    usage |= Use::eStorageBuffer | Use::eTransferSrc | Use::eTransferDst;
    const bool addressed = static_cast<bool>(usage & Use::eShaderDeviceAddress);
    buffer_ = device.handle().createBuffer({{}, bytes_, usage});
    const vk::MemoryRequirements needs = buffer_.getMemoryRequirements();
    const vk::MemoryAllocateFlagsInfo flags(addressed ? vk::MemoryAllocateFlagBits::eDeviceAddress
                                                      : vk::MemoryAllocateFlagBits{});
    const vk::MemoryAllocateInfo info(needs.size, kind_of(device, needs.memoryTypeBits, memory),
                                      addressed ? &flags : nullptr);
    try {
        memory_ = device.handle().allocateMemory(info);
    } catch (const vk::OutOfDeviceMemoryError&) {
        throw GpuMemoryError(fmt::format("\"{}\" does not have {:.0f} MB of free memory for {}",
                                         device.traits().about.name, static_cast<double>(bytes_) / 1e6,
                                         what));
    }
    buffer_.bindMemory(*memory_, 0);
    if (memory != GpuMemory::device)
        data_ = static_cast<std::byte*>(memory_.mapMemory(0, VK_WHOLE_SIZE));
}

vk::DeviceAddress GpuBuffer::address(const VulkanDevice& device) const {
    return device.handle().getBufferAddress({*buffer_});
}

} // namespace prt
