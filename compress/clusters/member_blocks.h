#pragma once

// Points grouped by cluster for SIMD processing.

#include "compress/clusters/points.h"
#include "runtime/core/support/parallel.h"

namespace prt {

/// Points of one cluster that are processed together, at most kLanes: cluster data is loaded once for all of
/// them.
struct MemberBlock {
    std::uint32_t cluster = 0;
    std::span<const std::uint32_t> points;
};

/// All points, grouped by cluster.
class MemberBlocks {
public:
    explicit MemberBlocks(std::span<const std::uint32_t> clusters);

    std::size_t size() const { return blocks_.size(); }
    MemberBlock operator[](std::size_t b) const {
        const Block& block = blocks_[b];
        return {block.cluster, std::span(points_).subspan(block.first, block.count)};
    }

private:
    struct Block {
        std::uint32_t cluster, first, count;
    };
    std::vector<std::uint32_t> points_; ///< sorted by cluster, then ascending
    std::vector<Block> blocks_;
};

/// Calls `visit(member_block, block)` for all points, grouped by cluster; `block` is [width][kLanes], as in
/// PointBlocks, padded with copies of its first point.
template <class Visit>
void for_member_blocks(const PointBlocks& points, std::span<const std::uint32_t> clusters, int threads,
                       Visit&& visit) {
    const MemberBlocks blocks(clusters);
    parallel_for(blocks.size(), 16, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> block(points.width() * kLanes);
        for (std::size_t b = begin; b < end; ++b) {
            points.gather(blocks[b].points, block.data());
            visit(blocks[b], block.data());
        }
    });
}

} // namespace prt
