#pragma once

// The rows of a gather on a device, in blocks: as many as have room stay there, the others come when they are
// wanted.

#include "transport/gather.h"
#include "vulkan/gpu_queue.h"

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
    /// As shaders/bake_gather.comp reads them.
    struct Buffers {
        GpuBuffer row_ends, sources, weights;
    };

    struct Room {
        std::size_t block = 256 << 20;   ///< bytes of a buffer
        std::size_t resident = SIZE_MAX; ///< bytes of all rows that stay, at most
    };
    /// Keeps references. Throws `GpuMemoryError` where the device has room for no block.
    GatherBlocks(const VulkanDevice& device, GpuQueue& queue, const GatherOperator& gather, const Room& room);

    std::span<const Block> all() const { return blocks_; }
    /// Where block `i` lies: those that are not resident share a place.
    const Buffers& buffers(std::size_t i) const { return blocks_[i].resident ? resident_[i] : shared_; }
    /// Has block `i` uploaded where it is not there.
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
    std::vector<Buffers> resident_; ///< [blocks], up to the first that has no room
    Buffers shared_;
    std::size_t in_shared_ = 0; ///< block that the shared place holds, counting from 1
    GpuBuffer staging_;
    std::size_t bytes_moved_ = 0;
};

} // namespace prt
