#pragma once

// The kernels that trace receivers, for one kind of results, and the tables that they read.

#include "bake/trace_gpu/gpu_scene.h"

#include <glm/vec2.hpp>

#include <compare>
#include <span>

namespace prt {

class TraceKernels {
public:
    /// Kind of the results.
    struct Kind {
        int order = 0;
        bool hits = false;   ///< hits are reported
        bool summed = false; ///< vectors are added to sums and not stored
        auto operator<=>(const Kind&) const = default;
    };
    /// Throws `Error` if the device does not accept the kernels.
    TraceKernels(const VulkanDevice& device, GpuQueue& queue, const GpuScene& scene, const Kind& kind);

    const Kind& kind() const { return kind_; }
    /// Number of floats that are read back per receiver.
    std::size_t numbers() const;
    bool has_alpha() const { return has_alpha_; }
    const GpuKernel& trace() const { return trace_; }
    const GpuKernel& count_blocked() const { return count_blocked_; }
    const GpuKernel& accumulate() const { return accumulate_; }
    /// Tables by binding.
    GpuResources tables() const;
    /// Uploads reversed Sobol points of a whole chunk, then of the last chunk. Waits for the upload.
    void set_samples(const VulkanDevice& device, GpuQueue& queue, std::span<const glm::uvec2> points);

private:
    Kind kind_;
    bool has_alpha_;
    GpuKernel trace_, count_blocked_, accumulate_;
    GpuBuffer sh_factors_, samples_;
};

} // namespace prt
