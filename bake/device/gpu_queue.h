#pragma once

// Work that a device executes in order, counted by a timeline semaphore.

#include "bake/device/gpu_buffer.h"

#include <cstdint>
#include <functional>

namespace prt {

class GpuQueue {
public:
    /// Number of a submission, starting at 1; 0: no submission.
    using Ticket = std::uint64_t;
    /// Maximum number of active submissions.
    static constexpr std::size_t kAtOnce = 8;

    explicit GpuQueue(const VulkanDevice& device);
    /// Waits for all submissions.
    ~GpuQueue();
    GpuQueue(const GpuQueue&) = delete;
    GpuQueue& operator=(const GpuQueue&) = delete;

    /// Submits the commands that `record` records. Waits only for the submission kAtOnce before it.
    Ticket submit(const std::function<void(const vk::raii::CommandBuffer&)>& record);
    /// Waits for a submission. Throws `GpuLost` if it does not end within a minute.
    void wait(Ticket ticket) const;
    /// Waits for all submissions without throwing. Call it before releasing resources that the device uses.
    void wait_for_all() const noexcept;
    /// Duration of one of the last submissions after it has ended; 0 if the device has no clock.
    double seconds(Ticket ticket) const;

private:
    const VulkanDevice& device_;
    vk::raii::CommandPool pool_;
    vk::raii::CommandBuffers commands_;
    vk::raii::Semaphore done_;
    vk::raii::QueryPool clocks_;
    Ticket last_ = 0;
};

/// Copies `bytes` to the device's memory and waits. `what`: content, for errors.
GpuBuffer uploaded(const VulkanDevice& device, GpuQueue& queue, std::span<const std::byte> bytes,
                   const char* what);
void copy(const vk::raii::CommandBuffer& commands, const GpuBuffer& from, const GpuBuffer& to,
          std::size_t bytes);
/// Makes writes of shaders and copies visible to following commands.
void barrier(const vk::raii::CommandBuffer& commands);
/// Makes writes of copies visible to the CPU.
void barrier_to_host(const vk::raii::CommandBuffer& commands);

} // namespace prt
