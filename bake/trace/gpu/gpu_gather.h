#pragma once

#include "trace/gpu/gather_blocks.h"
#include "transport/gather_product.h"
#include "vulkan/gpu_kernel.h"

#include <array>
#include <memory>
#include <vector>

namespace prt {

/// The gather in a compute shader (shaders/bake_gather.comp), whose rows stay on the device as far as there
/// is room.
class GpuGather final : public GatherProduct {
public:
    /// Keeps references. Throws `GpuMemoryError` where there is no room.
    GpuGather(const VulkanDevice& device, GpuQueue& queue, const GatherOperator& gather,
              const GatherBlocks::Room& room = {});
    ~GpuGather() override;
    GpuGather(const GpuGather&) = delete;
    GpuGather& operator=(const GpuGather&) = delete;

    void load(int order, std::span<const float> exit) override;
    void apply(std::size_t first, std::span<float> to) override;
    std::optional<BounceEnergy> bounce(Transfer& transfer, int bounces, const Progress& progress) override;
    std::size_t bytes_moved() const override { return bytes_moved_ + blocks_.bytes_moved(); }
    const GatherBlocks& blocks() const { return blocks_; }

private:
    class Values;

    Values& values(int order, bool with_total);
    /// Rows [first, end) from the values at `from` to those at the other place, row `first` to the beginning
    /// there.
    void gather(std::size_t first, std::size_t end, std::size_t from, bool add, const Progress& progress);

    const VulkanDevice& device_;
    GpuQueue& queue_;
    const GatherOperator& gather_;
    GatherBlocks blocks_;
    GpuBuffer reflectance_;
    std::unique_ptr<Values> values_;
    double work_per_second_ = 1e8; ///< products, until measured those of a software device
    std::size_t bytes_moved_ = 0;  ///< of transfer
};

} // namespace prt
