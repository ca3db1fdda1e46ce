#pragma once

// Uploads through a staging buffer.

#include "bake/device/gpu_queue.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace prt {

/// Appends values to a buffer on the device, in blocks of the size of a staging buffer.
class StagedWrites {
public:
    static constexpr std::size_t kBytes = 16 << 20; ///< size of a staging buffer

    StagedWrites(GpuQueue& queue, const GpuBuffer& staging, const GpuBuffer& to)
        : queue_(queue), staging_(staging), to_(to) {}

    template <class T>
    void append(std::span<const T> values) {
        for (std::span<const std::byte> rest = std::as_bytes(values); !rest.empty();) {
            const std::size_t now = std::min(rest.size(), staging_.bytes() - held_);
            std::copy_n(rest.data(), now, staging_.data() + held_);
            held_ += now;
            rest = rest.subspan(now);
            if (held_ == staging_.bytes())
                flush();
        }
    }
    /// Copies the staged values and waits.
    void flush() {
        if (held_ == 0)
            return;
        queue_.wait(queue_.submit([&](const vk::raii::CommandBuffer& commands) {
            commands.copyBuffer(staging_.handle(), to_.handle(), vk::BufferCopy(0, done_, held_));
        }));
        done_ += held_;
        held_ = 0;
    }

private:
    GpuQueue& queue_;
    const GpuBuffer& staging_;
    const GpuBuffer& to_;
    std::size_t held_ = 0, done_ = 0;
};

} // namespace prt
