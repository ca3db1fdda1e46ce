// Bricks of cells are made when a cell of them is first used.

#include "far/cell_grid.h"

#include "prt/support/error.h"

#include <utility>

namespace prt {
namespace {

/// Of a grid: 512 MB of numbers.
constexpr double kMostBricks = 1 << 27;

} // namespace

CellGrid::CellGrid(const glm::vec3& low, const glm::vec3& high, float size) : low_(low), size_(size) {
    const glm::dvec3 bricks = glm::floor(glm::dvec3(high - low) / static_cast<double>(size * kSide)) + 1.0;
    if (!(bricks.x * bricks.y * bricks.z <= kMostBricks))
        throw Error("the voxels of far blockers are too small for a scene of this size: choose a larger "
                    "distance");
    bricks_ = glm::ivec3(bricks);
    brick_of_.assign(static_cast<std::size_t>(bricks_.x) * static_cast<std::size_t>(bricks_.y) *
                         static_cast<std::size_t>(bricks_.z),
                     kNone);
}

std::uint32_t CellGrid::add(const glm::vec3& position) {
    const glm::ivec3 at = cell_at((position - low_) / size_, 1, bricks_ * kSide), brick = at / kSide;
    std::uint32_t& used = brick_of_[brick_at(brick)];
    if (used == kNone) {
        used = static_cast<std::uint32_t>(cells_.size());
        cells_.emplace_back().fill(kNone);
    }
    std::uint32_t& cell = cells_[used][place_in(at - brick * kSide)];
    if (cell == kNone) {
        cell = static_cast<std::uint32_t>(corners_.size());
        corners_.push_back(at);
    }
    return cell;
}

bool CellGrid::cut(const glm::vec3& origin, const glm::vec3& inverse, float& from, float& to) const {
    const glm::vec3 high(bricks_ * kSide);
    for (int a = 0; a < 3; ++a) {
        float first = -origin[a] * inverse[a], second = (high[a] - origin[a]) * inverse[a];
        if (first != first || second != second) // on a face that the ray runs along
            continue;
        if (first > second)
            std::swap(first, second);
        from = glm::max(from, first);
        to = glm::min(to, second);
    }
    return from < to;
}

} // namespace prt
