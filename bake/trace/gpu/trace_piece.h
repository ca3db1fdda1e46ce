#pragma once

// A piece of the rays of some receivers on its way through the device: what it works on, and what comes back.

#include "trace/gpu/gpu_scene.h"
#include "trace/gpu/trace_kernels.h"

#include <functional>
#include <span>

namespace prt {

class TracePiece {
public:
    /// Receivers, chunks of their rays (rows), and hits of scenes with alpha, at most.
    struct Room {
        std::size_t receivers = 0, rows = 0, hits = 0;
    };
    /// Takes what rays met, row by row or, of scenes with alpha, in any order.
    using TakeHits = std::function<void(std::span<const gpu::HitRecord>)>;

    /// Keeps a reference to `kernels`. Throws `GpuMemoryError` where the device has no such room.
    TracePiece(const VulkanDevice& device, const GpuScene& scene, const TraceKernels& kernels,
               const Room& room);

    const Room& room() const { return room_; }
    /// Where receivers go before `start`.
    std::span<gpu::Receiver> receivers() const { return buffers_.receivers.host.as<gpu::Receiver>(); }
    /// Traces the rays that `push` says, and has the device copy back what is asked of it.
    void start(GpuQueue& queue, const gpu::TracePush& push);
    /// Waits. Rays whose hits had no room are traced on, and so none is traced twice.
    void finish(GpuQueue& queue, const TakeHits& take);

    const gpu::TracePush& push() const { return push_; }
    /// How long the device worked on what has ended; 0 where it does not tell.
    double seconds() const { return seconds_; }
    /// [receivers][order² + 1], as bake_accumulate.comp says.
    std::span<const float> sums() const { return buffers_.sums.host.as<const float>(); }
    /// [rows]: how many rays are blocked, where everything is opaque and hits are noted.
    std::span<const std::uint32_t> blocked_rays() const {
        return buffers_.blocked_rays.host.as<const std::uint32_t>();
    }

private:
    /// On the device, and where the processor reads or writes it.
    struct Mirrored {
        GpuBuffer device, host;
    };
    struct Buffers {
        Mirrored receivers, sums, hits, state, blocked_rays;
        GpuBuffer blocked, shares, threads;
    };
    struct Bindings {
        GpuBindings trace, count_blocked, accumulate;
    };

    void bind(const VulkanDevice& device, const GpuScene& scene);
    std::size_t rows() const { return static_cast<std::size_t>(push_.receivers) * push_.chunks; }
    std::size_t sums_bytes() const;
    bool hits_in_any_order() const { return kernels_.notes_hits() && kernels_.has_alpha(); }
    void trace(const vk::raii::CommandBuffer& commands) const;
    void sum(const vk::raii::CommandBuffer& commands) const;
    void copy_hits(const vk::raii::CommandBuffer& commands) const;
    void wait(GpuQueue& queue, GpuQueue::Ticket ticket);
    void check_loops() const;
    std::size_t wanted_hits() const; ///< more than there is room for: threads have stopped

    const TraceKernels& kernels_;
    Room room_;
    Buffers buffers_;
    Bindings bindings_;
    gpu::TracePush push_{};
    GpuQueue::Ticket ticket_ = 0;
    double seconds_ = 0;
};

} // namespace prt
