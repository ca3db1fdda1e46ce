#pragma once

// The kernels that trace receivers, for one order and with or without hits, and the tables that they read.

#include "trace/gpu/gpu_scene.h"

#include <glm/vec2.hpp>

#include <span>

namespace prt {

class TraceKernels {
public:
    /// Throws `Error` where the device does not take them.
    TraceKernels(const VulkanDevice& device, GpuQueue& queue, const GpuScene& scene, int order, bool hits);

    int order() const { return order_; }
    bool notes_hits() const { return notes_hits_; }
    bool has_alpha() const { return has_alpha_; }
    const GpuKernel& trace() const { return trace_; }
    const GpuKernel& count_blocked() const { return count_blocked_; }
    const GpuKernel& accumulate() const { return accumulate_; }
    /// The tables, by binding.
    GpuResources tables() const;
    /// Uploads reversed Sobol points: of a whole chunk, then of the last one. Waits.
    void set_samples(const VulkanDevice& device, GpuQueue& queue, std::span<const glm::uvec2> points);

private:
    int order_;
    bool notes_hits_, has_alpha_;
    GpuKernel trace_, count_blocked_, accumulate_;
    GpuBuffer sh_factors_, samples_;
};

} // namespace prt
