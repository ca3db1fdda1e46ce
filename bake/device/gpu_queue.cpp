// Submits command buffers in rotation and waits for their tickets.

#include "bake/device/gpu_queue.h"

#include <algorithm>

namespace prt {
namespace {

constexpr std::uint64_t kLongest =
    60'000'000'000; ///< nanoseconds; dispatches are sized for a tenth of a second

vk::raii::Semaphore timeline(const vk::raii::Device& device) {
    const vk::SemaphoreTypeCreateInfo type(vk::SemaphoreType::eTimeline, 0);
    return device.createSemaphore({{}, &type});
}

} // namespace

GpuQueue::GpuQueue(const VulkanDevice& device)
    : device_(device),
      pool_(device.handle(), {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, device.queue_family()}),
      commands_(device.handle(), {*pool_, vk::CommandBufferLevel::ePrimary, kAtOnce}),
      done_(timeline(device.handle())),
      clocks_(device.handle(), {{}, vk::QueryType::eTimestamp, 2 * kAtOnce}) {}

GpuQueue::~GpuQueue() {
    wait_for_all();
}

void GpuQueue::wait_for_all() const noexcept {
    try {
        wait(last_);
    } catch (const std::exception&) { // a lost device does not work on anything
    }
}

GpuQueue::Ticket GpuQueue::submit(const std::function<void(const vk::raii::CommandBuffer&)>& record) {
    const Ticket ticket = last_ + 1;
    if (ticket > kAtOnce)
        wait(ticket - kAtOnce);
    const std::size_t position = ticket % kAtOnce;
    const vk::raii::CommandBuffer& commands = commands_[position];
    const auto first_clock = static_cast<std::uint32_t>(2 * position);
    const bool clocked = device_.traits().clock_seconds > 0;
    commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    if (clocked) {
        commands.resetQueryPool(*clocks_, first_clock, 2);
        commands.writeTimestamp(vk::PipelineStageFlagBits::eTopOfPipe, *clocks_, first_clock);
    }
    barrier(commands); // wait for previous submissions
    record(commands);
    if (clocked)
        commands.writeTimestamp(vk::PipelineStageFlagBits::eBottomOfPipe, *clocks_, first_clock + 1);
    commands.end();
    const vk::TimelineSemaphoreSubmitInfo number(0, nullptr, 1, &ticket);
    const vk::SubmitInfo info(0, nullptr, nullptr, 1, &*commands, 1, &*done_, &number);
    device_.queue().submit(info);
    last_ = ticket;
    return ticket;
}

void GpuQueue::wait(Ticket ticket) const {
    if (ticket == 0)
        return;
    if (device_.handle().waitSemaphores({{}, 1, &*done_, &ticket}, kLongest) == vk::Result::eTimeout)
        throw GpuLost("the GPU did not finish within a minute work that should take a tenth of a second");
}

double GpuQueue::seconds(Ticket ticket) const {
    if (ticket == 0 || !(device_.traits().clock_seconds > 0)) // clocks that never ran must not be read
        return 0;
    const auto [result, clocks] = clocks_.getResults<std::uint64_t>(
        static_cast<std::uint32_t>(2 * (ticket % kAtOnce)), 2, 2 * sizeof(std::uint64_t),
        sizeof(std::uint64_t), vk::QueryResultFlagBits::e64);
    const std::uint32_t unused = 64 - device_.traits().clock_bits;
    const std::uint64_t steps = (clocks[1] - clocks[0]) << unused >> unused;
    return result == vk::Result::eSuccess ? static_cast<double>(steps) * device_.traits().clock_seconds : 0;
}

GpuBuffer uploaded(const VulkanDevice& device, GpuQueue& queue, std::span<const std::byte> bytes,
                   const char* what) {
    GpuBuffer buffer(device, bytes.size(), GpuMemory::device, what);
    const GpuBuffer staging(device, bytes.size(), GpuMemory::upload, what);
    std::ranges::copy(bytes, staging.data());
    queue.wait(queue.submit(
        [&](const vk::raii::CommandBuffer& commands) { copy(commands, staging, buffer, buffer.bytes()); }));
    return buffer;
}

void copy(const vk::raii::CommandBuffer& commands, const GpuBuffer& from, const GpuBuffer& to,
          std::size_t bytes) {
    commands.copyBuffer(from.handle(), to.handle(), vk::BufferCopy(0, 0, bytes));
}

void barrier(const vk::raii::CommandBuffer& commands) {
    using Stage = vk::PipelineStageFlagBits;
    using Access = vk::AccessFlagBits;
    const vk::MemoryBarrier memory(Access::eShaderWrite | Access::eTransferWrite | Access::eHostWrite,
                                   Access::eShaderRead | Access::eShaderWrite | Access::eTransferRead |
                                       Access::eTransferWrite);
    commands.pipelineBarrier(Stage::eComputeShader | Stage::eTransfer | Stage::eHost,
                             Stage::eComputeShader | Stage::eTransfer, {}, memory, {}, {});
}

void barrier_to_host(const vk::raii::CommandBuffer& commands) {
    const vk::MemoryBarrier memory(vk::AccessFlagBits::eTransferWrite | vk::AccessFlagBits::eShaderWrite,
                                   vk::AccessFlagBits::eHostRead);
    commands.pipelineBarrier(vk::PipelineStageFlagBits::eTransfer | vk::PipelineStageFlagBits::eComputeShader,
                             vk::PipelineStageFlagBits::eHost, {}, memory, {}, {});
}

} // namespace prt
