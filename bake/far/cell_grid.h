#pragma once

// Cubes of space of which few are used, and the way of a ray through them.

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace prt {

/// Steps a ray through cubes of equal sides, one face at a time (Amanatides and Woo 1987).
struct CellSteps {
    glm::ivec3 at, step;
    glm::vec3 next, delta; ///< lengths of the ray to the next face along each axis, and from face to face

    /// Starts at `t`, whose cube is `first`; `inverse` of the direction, infinite along axes that it keeps
    /// to.
    CellSteps(const glm::vec3& origin, const glm::vec3& inverse, const glm::ivec3& first, float side)
        : at(first) {
        for (int a = 0; a < 3; ++a) {
            const bool up = inverse[a] > 0;
            step[a] = up ? 1 : -1;
            const bool moves = inverse[a] < kNever && inverse[a] > -kNever;
            next[a] =
                moves ? (static_cast<float>(at[a] + (up ? 1 : 0)) * side - origin[a]) * inverse[a] : kNever;
            delta[a] = moves ? side * glm::abs(inverse[a]) : 0.0f;
        }
    }
    float leaves() const { return glm::min(next.x, glm::min(next.y, next.z)); }
    void advance() {
        const int a = next.x <= next.y ? (next.x <= next.z ? 0 : 2) : (next.y <= next.z ? 1 : 2);
        at[a] += step[a];
        next[a] += delta[a];
    }

    static constexpr float kNever = std::numeric_limits<float>::infinity();
};

/// Cells are numbered from 0 in the order in which they are added. They lie in bricks of 8 along each side.
class CellGrid {
public:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    CellGrid() = default;
    /// Cells of side `size` round the box from `low` to `high`. Throws `Error` where these are too many.
    CellGrid(const glm::vec3& low, const glm::vec3& high, float size);

    float size() const { return size_; }
    std::size_t cells() const { return corners_.size(); }
    std::size_t bytes() const {
        return brick_of_.size() * sizeof(std::uint32_t) + cells_.size() * sizeof(cells_[0]) +
               corners_.size() * sizeof(glm::ivec3);
    }
    /// The number of the cell that `position`, in the box, lies in.
    std::uint32_t add(const glm::vec3& position);
    glm::vec3 corner(std::uint32_t cell) const { return low_ + glm::vec3(corners_[cell]) * size_; }

    /// Calls `visit(cell, begin, end)` for the used cells on the way [from, to] of a ray of unit `direction`,
    /// with the ways to where it comes in and leaves, in sides of a cell, until it returns false.
    template <class Visit>
    void walk(const glm::vec3& origin, const glm::vec3& direction, float from, float to, Visit&& visit) const;

private:
    static constexpr int kSide = 8;
    static constexpr std::size_t kBrick = kSide * kSide * kSide;

    std::size_t brick_at(const glm::ivec3& brick) const {
        return (static_cast<std::size_t>(brick.z) * static_cast<std::size_t>(bricks_.y) +
                static_cast<std::size_t>(brick.y)) *
                   static_cast<std::size_t>(bricks_.x) +
               static_cast<std::size_t>(brick.x);
    }
    static std::size_t place_in(const glm::ivec3& inside) {
        return static_cast<std::size_t>((inside.z * kSide + inside.y) * kSide + inside.x);
    }
    static glm::ivec3 cell_at(const glm::vec3& place, float side, const glm::ivec3& end) {
        return glm::clamp(glm::ivec3(glm::floor(place / side)), glm::ivec3(0), end - 1);
    }
    /// Cuts [from, to] to the box; returns whether something is left.
    bool cut(const glm::vec3& origin, const glm::vec3& inverse, float& from, float& to) const;

    glm::vec3 low_{0};
    float size_ = 1;
    glm::ivec3 bricks_{0};
    std::vector<std::uint32_t> brick_of_;                  ///< [bricks] number among those that are used
    std::vector<std::array<std::uint32_t, kBrick>> cells_; ///< [used bricks] numbers of cells
    std::vector<glm::ivec3> corners_;                      ///< [cells]
};

template <class Visit>
void CellGrid::walk(const glm::vec3& origin, const glm::vec3& direction, float from, float to,
                    Visit&& visit) const {
    const float scale = 1 / size_;
    const glm::vec3 start = (origin - low_) * scale, inverse = 1.0f / direction;
    float t = from * scale, end = to * scale;
    if (!cut(start, inverse, t, end))
        return;
    constexpr auto kBrickWidth = static_cast<float>(kSide);
    CellSteps bricks(start, inverse, cell_at(start + direction * t, kBrickWidth, bricks_), kBrickWidth);
    while (t < end) {
        const float leaves = glm::min(bricks.leaves(), end);
        const std::uint32_t used = brick_of_[brick_at(bricks.at)];
        if (used != kNone) {
            const std::array<std::uint32_t, kBrick>& cells = cells_[used];
            const glm::vec3 inside = start - glm::vec3(bricks.at) * kBrickWidth;
            CellSteps steps(inside, inverse, cell_at(inside + direction * t, 1, glm::ivec3(kSide)), 1);
            while (t < leaves) {
                const float next = glm::min(steps.leaves(), leaves);
                const std::uint32_t cell = cells[place_in(steps.at)];
                if (cell != kNone && next > t && !visit(cell, t, next))
                    return;
                t = glm::max(t, next);
                steps.advance();
                if (glm::any(glm::lessThan(steps.at, glm::ivec3(0))) ||
                    glm::any(glm::greaterThanEqual(steps.at, glm::ivec3(kSide))))
                    break;
            }
        }
        t = glm::max(t, leaves);
        bricks.advance();
        if (glm::any(glm::lessThan(bricks.at, glm::ivec3(0))) ||
            glm::any(glm::greaterThanEqual(bricks.at, bricks_)))
            return;
    }
}

} // namespace prt
