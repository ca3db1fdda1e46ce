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
    /// Where vectors are added to: [sums][order²] in fixed point, and those with signs.
    struct Sums {
        const GpuBuffer &plain, &with_signs;
    };
    /// Takes what rays met, row by row or, of scenes with alpha, in any order.
    using TakeHits = std::function<void(std::span<const gpu::HitRecord>)>;

    /// Keeps a reference to `kernels`, and to what is in `sums`, which is there where they sum. Throws
    /// `GpuMemoryError` where the device has no such room.
    TracePiece(const VulkanDevice& device, const GpuScene& scene, const TraceKernels& kernels,
               const Room& room, const Sums* sums = nullptr);

    const Room& room() const { return room_; }
    /// Where receivers go before `start`.
    std::span<gpu::Receiver> receivers() const { return buffers_.receivers.host.as<gpu::Receiver>(); }
    /// The same of what their vectors are added to.
    std::span<gpu::SumRow> sum_rows() const { return buffers_.sum_rows.host.as<gpu::SumRow>(); }
    /// Traces the rays that `push` says, and has the device copy back what is asked of it.
    void start(GpuQueue& queue, const gpu::TracePush& push);
    /// Waits. Rays whose hits had no room are traced on, and so none is traced twice.
    void finish(GpuQueue& queue, const TakeHits& take);

    const gpu::TracePush& push() const { return push_; }
    /// How long the device worked on what has ended; 0 where it does not tell.
    double seconds() const { return seconds_; }
    /// [receivers][TraceKernels::numbers], as bake_accumulate.comp says.
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
        Mirrored receivers, sum_rows, sums, hits, state, blocked_rays;
        GpuBuffer blocked, shares, threads, no_sums;
    };
    struct Bindings {
        GpuBindings trace, count_blocked, accumulate;
    };

    void bind(const VulkanDevice& device, const GpuScene& scene, const Sums& sums);
    std::size_t rows() const { return static_cast<std::size_t>(push_.receivers) * push_.chunks; }
    bool notes_hits() const { return kernels_.kind().hits; }
    bool hits_in_any_order() const { return notes_hits() && kernels_.has_alpha(); }
    /// Once no thread stops any more: what is added to sums of many cannot be taken back.
    bool sums_at_the_end() const { return hits_in_any_order() && kernels_.kind().summed; }
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
