#pragma once

// Gather operator on a Vulkan device.

#include "bake/device/gpu_kernel.h"
#include "bake/trace/gather_product.h"
#include "bake/trace_gpu/gather_blocks.h"

#include <memory>
#include <optional>

namespace prt {

/// Applies the gather operator in a compute shader (shaders/bake_gather.comp). Its rows stay on the device as
/// far as they fit into memory.
class GpuGather final : public GatherProduct {
public:
    /// Keeps references. Throws `GpuMemoryError` if there is too little memory.
    GpuGather(const VulkanDevice& device, GpuQueue& queue, const GatherOperator& gather,
              const GatherBlocks::Room& room = {});
    ~GpuGather() override;
    GpuGather(const GpuGather&) = delete;
    GpuGather& operator=(const GpuGather&) = delete;

    void load(int order, std::span<const float> exit) override;
    void apply(std::size_t first, std::span<float> to) override;
    /// Adds in fixed point, so that sums do not depend on the order.
    bool apply_to_sums(const SumRows& to, std::span<float> sums) override;
    std::optional<BounceEnergy> bounce(Transfer& transfer, int bounces, const Progress& progress) override;
    std::size_t bytes_moved() const override { return bytes_moved_ + blocks_.bytes_moved(); }
    const GatherBlocks& blocks() const { return blocks_; }

private:
    class Values;
    struct Kernel;
    /// Gathers rows [first, end) from buffer `from` to the other buffer, row `first` to its beginning; or to
    /// sums.
    struct Task {
        std::size_t first, end, from = 0;
        bool add = false; ///< also add to the total
    };

    Values& values(int order, bool with_total);
    void gather(const Kernel& kernel, const Task& task, const Progress& progress);
    void upload_sum_rows(const SumRows& rows);

    const VulkanDevice& device_;
    GpuQueue& queue_;
    const GatherOperator& gather_;
    GatherBlocks blocks_;
    GpuBuffer reflectance_;
    GpuBuffer unused_;                  ///< bound to bindings that a kernel declares but does not read
    std::optional<GpuBuffer> sum_rows_; ///< rows of the last call of apply_to_sums
    std::unique_ptr<Values> values_;
    float largest_ = 0;            ///< maximum of the exit transfer
    double work_per_second_ = 1e8; ///< products per second; until measured, the speed of a software device
    std::size_t bytes_moved_ = 0;  ///< transferred bytes of exit transfer
};

} // namespace prt
