// Uploads rows through one staging buffer.

#include "bake/trace_gpu/gather_blocks.h"

#include "bake/device/staged_writes.h"

#include <algorithm>

namespace prt {
GatherBlocks::GatherBlocks(const VulkanDevice& device, GpuQueue& queue, const GatherOperator& gather,
                           const Room& room)
    : device_(device), queue_(queue), gather_(gather),
      staging_(device, StagedWrites::kBytes, GpuMemory::upload, "rows in transfer") {
    cut(room.block);
    std::size_t bytes = 0;
    for (Block& block : blocks_) {
        bytes += bytes_of(block);
        if (bytes > room.resident)
            break;
        try {
            resident_.push_back(make(block));
        } catch (const GpuMemoryError&) {
            if (!resident_.empty()) { // transfer and the shared buffers need the memory of one block
                resident_.pop_back();
                blocks_[resident_.size()].resident = false;
            }
            break;
        }
        block.resident = true;
        upload(block, resident_.back());
    }
    Block largest;
    for (const Block& block : std::span(blocks_).subspan(resident_.size())) {
        largest.rows = std::max(largest.rows, block.rows);
        largest.entries = std::max(largest.entries, block.entries);
    }
    if (largest.rows > 0)
        shared_ = make(largest);
}

std::size_t GatherBlocks::bytes_of(const Block& block) const {
    return 4 * (block.rows + 1) + 4 * (1 + weights_per_entry()) * block.entries;
}

std::size_t GatherBlocks::weights_per_entry() const {
    return gather_.reflectance().empty() ? static_cast<std::size_t>(gather_.channels()) : 1;
}

void GatherBlocks::cut(std::size_t block_bytes) {
    const std::size_t bytes = std::min(block_bytes, device_.traits().max_bytes),
                      max_entries = bytes / (4 * weights_per_entry()), max_rows = bytes / 4 - 1;
    const std::span<const GatherOperator::Row> rows = gather_.all_rows();
    for (std::size_t r = 0; r < rows.size(); ++r) {
        if (blocks_.empty() || blocks_.back().entries + rows[r].count > max_entries ||
            blocks_.back().rows == max_rows)
            blocks_.push_back({.first = r});
        ++blocks_.back().rows;
        blocks_.back().entries += rows[r].count;
    }
}

GatherBlocks::Buffers GatherBlocks::make(const Block& block) const {
    constexpr const char* kRows = "the rows of the gather";
    return {{device_, 4 * (block.rows + 1), GpuMemory::device, kRows},
            {device_, 4 * block.entries, GpuMemory::device, kRows},
            {device_, 4 * weights_per_entry() * block.entries, GpuMemory::device, kRows}};
}

void GatherBlocks::upload(const Block& block, const Buffers& to) {
    const std::span<const GatherOperator::Row> rows = gather_.all_rows().subspan(block.first, block.rows);
    StagedWrites row_ends(queue_, staging_, to.row_ends);
    std::uint32_t end = 0;
    row_ends.append(std::span<const std::uint32_t>(&end, 1));
    for (const GatherOperator::Row& row : rows) {
        end += row.count;
        row_ends.append(std::span<const std::uint32_t>(&end, 1));
    }
    row_ends.flush();
    StagedWrites sources(queue_, staging_, to.sources);
    for (const GatherOperator::Row& row : rows)
        sources.append(std::span<const std::uint32_t>(row.sources.get(), row.count));
    sources.flush();
    StagedWrites weights(queue_, staging_, to.weights);
    for (const GatherOperator::Row& row : rows)
        weights.append(std::span<const float>(row.weights.get(), weights_per_entry() * row.count));
    weights.flush();
    bytes_moved_ += bytes_of(block);
}

void GatherBlocks::want(std::size_t i) {
    if (blocks_[i].resident || in_shared_ == i + 1)
        return;
    upload(blocks_[i], shared_);
    in_shared_ = i + 1;
}

} // namespace prt
