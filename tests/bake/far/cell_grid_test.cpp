// The way of a ray through cells.

#include "far/cell_grid.h"
#include "prt/support/error.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <random>

namespace prt {
namespace {

constexpr float kFarthest = std::numeric_limits<float>::infinity();

CellGrid full_grid(const glm::ivec3& cells, const glm::vec3& low, float size) {
    CellGrid grid(low, low + (glm::vec3(cells) - 0.5f) * size, size);
    for (int z = 0; z < cells.z; ++z)
        for (int y = 0; y < cells.y; ++y)
            for (int x = 0; x < cells.x; ++x)
                grid.add(low + (glm::vec3(x, y, z) + 0.5f) * size);
    return grid;
}

/// Length of the way [from, to] inside the box, by slabs.
double length_inside(const glm::vec3& origin, const glm::vec3& direction, double from, double to,
                     const glm::vec3& low, const glm::vec3& high) {
    for (int a = 0; a < 3; ++a) {
        const double o = static_cast<double>(origin[a]), d = static_cast<double>(direction[a]);
        if (d == 0) {
            if (o < static_cast<double>(low[a]) || o > static_cast<double>(high[a]))
                return 0;
            continue;
        }
        const double t0 = (static_cast<double>(low[a]) - o) / d, t1 = (static_cast<double>(high[a]) - o) / d;
        from = std::max(from, std::min(t0, t1));
        to = std::min(to, std::max(t0, t1));
    }
    return std::max(0.0, to - from);
}

TEST(CellGrid, RaysCrossEveryCellOnTheirWayOnce) {
    const glm::ivec3 cells(19, 5, 11);
    const glm::vec3 low(-3, 2, 7);
    constexpr float kSize = 0.37f;
    const CellGrid grid = full_grid(cells, low, kSize);
    ASSERT_EQ(grid.cells(), 19u * 5u * 11u);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-4, 12), unit(-1, 1);
    for (int i = 0; i < 20000; ++i) {
        glm::vec3 direction(unit(random), unit(random), unit(random));
        if (i % 4 == 1) // along axes and planes
            direction[i % 3] = 0;
        if (i % 4 == 2)
            direction = {0, i % 8 == 2 ? 1 : -1, 0};
        direction = glm::normalize(direction);
        const glm::vec3 origin =
            low + glm::vec3(place(random), place(random), place(random)) * kSize * (i % 2 == 0 ? 1.0f : 0.5f);
        const float from = i % 3 == 0 ? 0.0f : 0.8f, to = i % 5 == 0 ? 3.0f : kFarthest;
        float length = 0, last = from / kSize;
        grid.walk(origin, direction, from, to, [&](std::uint32_t cell, float begin, float end) {
            EXPECT_GE(begin, last - 1e-4f);
            EXPECT_GT(end, begin);
            last = end;
            length += end - begin;
            const glm::vec3 middle = origin + 0.5f * (begin + end) * kSize * direction;
            const glm::vec3 off = (middle - grid.corner(cell)) / kSize;
            for (int a = 0; a < 3; ++a) {
                EXPECT_GE(off[a], -1e-3f);
                EXPECT_LE(off[a], 1 + 1e-3f);
            }
            return true;
        });
        const double expected = length_inside(origin, direction, static_cast<double>(from),
                                              static_cast<double>(to), low, low + glm::vec3(cells) * kSize);
        ASSERT_NEAR(static_cast<double>(length * kSize), expected, 2e-3) << i;
    }
}

TEST(CellGrid, LeavesOutWhatIsNotUsedAndStopsWhenAsked) {
    CellGrid grid({0, 0, 0}, {100, 3, 3}, 1);
    for (const float x : {2.5f, 50.5f, 70.5f})
        grid.add({x, 0.5f, 0.5f});
    EXPECT_EQ(grid.add({50.2f, 0.9f, 0.1f}), 1u) << "the same cell";
    std::vector<std::uint32_t> met;
    grid.walk({-1, 0.5f, 0.5f}, {1, 0, 0}, 0, kFarthest, [&](std::uint32_t cell, float begin, float end) {
        met.push_back(cell);
        EXPECT_NEAR(end - begin, 1, 1e-4);
        return met.size() < 2;
    });
    EXPECT_EQ(met, (std::vector<std::uint32_t>{0, 1}));
}

TEST(CellGrid, IsRefusedWhereItWouldBeTooLarge) {
    EXPECT_THROW(CellGrid({0, 0, 0}, {1e9f, 1e9f, 1e9f}, 1), Error);
}

} // namespace
} // namespace prt
