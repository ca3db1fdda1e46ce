#pragma once

// A piece of the rays of some receivers on the device, with its buffers and its results.

#include "bake/trace_gpu/gpu_scene.h"
#include "bake/trace_gpu/trace_kernels.h"

#include <functional>
#include <span>

namespace prt {

class TracePiece {
public:
    /// Maximum number of receivers, of chunks of their rays (rows), and of hits in scenes with alpha.
    struct Room {
        std::size_t receivers = 0, rows = 0, hits = 0;
    };
    /// Buffers that vectors are added to: [sums][order²] in fixed point, with and without signs.
    struct Sums {
        const GpuBuffer &plain, &with_signs;
    };
    /// Takes hits row by row, or in any order for scenes with alpha.
    using TakeHits = std::function<void(std::span<const gpu::HitRecord>)>;

    /// Keeps references to `kernels` and to the buffers of `sums`, which are required if the kernels sum
    /// vectors. Throws `GpuMemoryError` if the device has too little memory.
    TracePiece(const VulkanDevice& device, const GpuScene& scene, const TraceKernels& kernels,
               const Room& room, const Sums* sums = nullptr);

    const Room& room() const { return room_; }
    /// Receivers of the piece; write them before `start`.
    std::span<gpu::Receiver> receivers() const { return buffers_.receivers.host.as<gpu::Receiver>(); }
    /// Rows of sums for the receivers; write them before `start`.
    std::span<gpu::SumRow> sum_rows() const { return buffers_.sum_rows.host.as<gpu::SumRow>(); }
    /// Starts tracing the rays described by `push`, and copying the results back.
    void start(GpuQueue& queue, const gpu::TracePush& push);
    /// Waits for the results. Rays whose hits did not fit into the buffer continue, and no ray is traced
    /// twice.
    void finish(GpuQueue& queue, const TakeHits& take);

    const gpu::TracePush& push() const { return push_; }
    /// Time that the device needed for finished work; 0 if the device does not report it.
    double seconds() const { return seconds_; }
    /// [receivers][TraceKernels::numbers] as defined in bake_accumulate.comp.
    std::span<const float> sums() const { return buffers_.sums.host.as<const float>(); }
    /// [rows] number of blocked rays, if all surfaces are opaque and hits are reported.
    std::span<const std::uint32_t> blocked_rays() const {
        return buffers_.blocked_rays.host.as<const std::uint32_t>();
    }

private:
    /// A buffer on the device and its copy for the CPU.
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
    /// Whether to sum after all threads have finished, because values cannot be removed from shared sums.
    bool sums_at_the_end() const { return hits_in_any_order() && kernels_.kind().summed; }
    void trace(const vk::raii::CommandBuffer& commands) const;
    void sum(const vk::raii::CommandBuffer& commands) const;
    void copy_hits(const vk::raii::CommandBuffer& commands) const;
    void wait(GpuQueue& queue, GpuQueue::Ticket ticket);
    void check_loops() const;
    std::size_t wanted_hits() const; ///< more than the buffer holds: threads have stopped

    const TraceKernels& kernels_;
    Room room_;
    Buffers buffers_;
    Bindings bindings_;
    gpu::TracePush push_{};
    GpuQueue::Ticket ticket_ = 0;
    double seconds_ = 0;
};

} // namespace prt
