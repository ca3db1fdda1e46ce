// Chooses bricks to split, and changes the levels of a grid.

#include "bake/products/volumes/refine_bricks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace prt {
namespace {

/// Share of a brick's squared error that remains after a split into eight: approximately the value measured
/// in a room with columns, where light is steep at edges.
constexpr double kLeft = 0.35;

VolumeGrid with_levels_raised(VolumeGrid grid, int levels) {
    grid.spacing /= static_cast<float>(1 << levels);
    grid.size *= 1 << levels;
    for (VolumeBrick& brick : grid.bricks) {
        brick.position *= 1 << levels;
        brick.level += levels;
    }
    return grid;
}

} // namespace

VolumeGrid with_finer_levels(VolumeGrid grid) {
    int most = 0;
    for (const VolumeBrick& brick : grid.bricks)
        most = std::max(most, brick.level);
    const int longest = std::max({grid.size.x, grid.size.y, grid.size.z});
    int levels = std::min(kMaxRefinements, kMaxBrickLevel - most);
    while (levels > 0 && longest << levels > kMaxBricksAlong)
        --levels;
    return with_levels_raised(std::move(grid), levels);
}

VolumeGrid without_unused_levels(VolumeGrid grid) {
    int levels = kMaxBrickLevel;
    for (const VolumeBrick& brick : grid.bricks)
        levels = std::min(levels, brick.level);
    // A box that is not a multiple of coarser bricks keeps its levels.
    while (levels > 0 && grid.size % (1 << levels) != glm::ivec3(0))
        --levels;
    grid.spacing *= static_cast<float>(1 << levels);
    grid.size /= 1 << levels;
    for (VolumeBrick& brick : grid.bricks) {
        brick.position /= 1 << levels;
        brick.level -= levels;
    }
    return grid;
}

VolumeGrid with_split_bricks(const VolumeGrid& grid, const std::vector<bool>& splits) {
    VolumeGrid finer = grid;
    finer.bricks.clear();
    for (std::size_t b = 0; b < grid.bricks.size(); ++b) {
        const VolumeBrick& brick = grid.bricks[b];
        if (!splits[b]) {
            finer.bricks.push_back(brick);
            continue;
        }
        const int step = 1 << (brick.level - 1);
        for (int i = 0; i < 8; ++i)
            finer.bricks.push_back(
                {brick.position + step * glm::ivec3(i & 1, i >> 1 & 1, i >> 2), brick.level - 1});
    }
    return finer;
}

std::vector<bool> bricks_to_split(const VolumeGrid& grid, std::span<const BrickError> errors, double target) {
    BrickError all;
    for (const BrickError& e : errors)
        all.add(1, e);
    const double kinds = (all.norm[0] > 0 ? 1 : 0) + (all.norm[1] > 0 ? 1 : 0);
    std::vector<double> shares(errors.size(), 0.0);
    for (std::size_t b = 0; b < errors.size(); ++b)
        for (std::size_t k = 0; k < 2; ++k)
            shares[b] += all.norm[k] > 0 ? errors[b].error[k] / (kinds * all.norm[k]) : 0.0;
    double left = std::accumulate(shares.begin(), shares.end(), 0.0);
    std::vector<std::size_t> order(errors.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t b) { return shares[b]; });
    std::vector<bool> splits(errors.size(), false);
    for (const std::size_t b : order) {
        if (left <= target * target)
            break;
        if (grid.bricks[b].level == 0)
            continue;
        splits[b] = true;
        left -= (1 - std::pow(kLeft, grid.bricks[b].level)) * shares[b]; // assumes splits down to the finest
                                                                         // level
    }
    return splits;
}

} // namespace prt
