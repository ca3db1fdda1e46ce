#pragma once

// Rows of a gather operator on a device, in blocks. The blocks that fit into memory stay there; the others
// are uploaded when they are needed.

#include "bake/device/gpu_queue.h"
#include "bake/trace/gather.h"

#include <cstdint>
#include <span>
#include <vector>

namespace prt {

class GatherBlocks {
public:
    struct Block {
        std::size_t first = 0, rows = 0, entries = 0;
        bool resident = false;
        std::size_t end() const { return first + rows; }
    };
    /// Buffers in the layout of shaders/bake_gather.comp.
    struct Buffers {
        GpuBuffer row_ends, sources, weights;
    };

    struct Room {
        std::size_t block = 256 << 20;   ///< maximum bytes of a buffer
        std::size_t resident = SIZE_MAX; ///< maximum bytes of all resident rows
    };
    /// Keeps references. Throws `GpuMemoryError` if the device has no memory for a single block.
    GatherBlocks(const VulkanDevice& device, GpuQueue& queue, const GatherOperator& gather, const Room& room);

    std::span<const Block> all() const { return blocks_; }
    /// Buffers of block `i`: blocks that are not resident share one set of buffers.
    const Buffers& buffers(std::size_t i) const { return blocks_[i].resident ? resident_[i] : shared_; }
    /// Uploads block `i` if it is not on the device.
    void want(std::size_t i);
    std::size_t bytes_moved() const { return bytes_moved_; }

private:
    std::size_t weights_per_entry() const;
    void cut(std::size_t block_bytes);
    std::size_t bytes_of(const Block& block) const;
    Buffers make(const Block& block) const;
    void upload(const Block& block, const Buffers& to);

    const VulkanDevice& device_;
    GpuQueue& queue_;
    const GatherOperator& gather_;
    std::vector<Block> blocks_;
    std::vector<Buffers> resident_; ///< resident blocks, from the first block on
    Buffers shared_;
    std::size_t in_shared_ = 0; ///< index of the block in the shared buffers, counting from 1; 0: none
    GpuBuffer staging_;
    std::size_t bytes_moved_ = 0;
};

} // namespace prt
