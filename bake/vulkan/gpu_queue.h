#pragma once

// Work that a device does in order, counted by a timeline semaphore.

#include "vulkan/gpu_buffer.h"

#include <cstdint>
#include <functional>

namespace prt {

class GpuQueue {
public:
    /// Number of a submission, from 1 on; 0: of none.
    using Ticket = std::uint64_t;
    /// Submissions that may be under way at once.
    static constexpr std::size_t kAtOnce = 8;

    explicit GpuQueue(const VulkanDevice& device);
    /// Waits for everything.
    ~GpuQueue();
    GpuQueue(const GpuQueue&) = delete;
    GpuQueue& operator=(const GpuQueue&) = delete;

    /// Submits what `record` records, and waits for none but the eighth before it.
    Ticket submit(const std::function<void(const vk::raii::CommandBuffer&)>& record);
    /// Throws `GpuLost` after a minute without an end.
    void wait(Ticket ticket) const;
    /// For everything, without throwing: before what the device works on goes.
    void wait_for_all() const noexcept;
    /// How long one of the last submissions took, once it has ended; 0 where the device has no clock.
    double seconds(Ticket ticket) const;

private:
    const VulkanDevice& device_;
    vk::raii::CommandPool pool_;
    vk::raii::CommandBuffers commands_;
    vk::raii::Semaphore done_;
    vk::raii::QueryPool clocks_;
    Ticket last_ = 0;
};

/// `bytes` in the device's memory; `what` they are. Waits.
GpuBuffer uploaded(const VulkanDevice& device, GpuQueue& queue, std::span<const std::byte> bytes,
                   const char* what);
void copy(const vk::raii::CommandBuffer& commands, const GpuBuffer& from, const GpuBuffer& to,
          std::size_t bytes);
/// What shaders and copies wrote is there for those that follow.
void barrier(const vk::raii::CommandBuffer& commands);
/// What copies wrote is there for the processor.
void barrier_to_host(const vk::raii::CommandBuffer& commands);

} // namespace prt
