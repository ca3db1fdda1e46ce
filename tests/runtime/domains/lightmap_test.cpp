// Lightmaps in memory: which texels filters read, and which are neighbours.

#include "prt/core/lightmap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace prt {
namespace {

TEST(BilinearTexels, SumToOneAndReproduceLinearFunctions) {
    const LightmapSize size{7, 5};
    for (double x = 0.5; x <= 6.5; x += 0.37)
        for (double y = 0.5; y <= 4.5; y += 0.29) {
            const BilinearTexels filter = bilinear_texels(size, x, y);
            double sum = 0, value = 0;
            for (std::size_t i = 0; i < 4; ++i) {
                const std::uint32_t column_index = filter.texels[i] % 7, row_index = filter.texels[i] / 7;
                const double column = column_index + 0.5, row = row_index + 0.5;
                sum += filter.weights[i];
                value += filter.weights[i] * (3 * column - 2 * row);
            }
            EXPECT_NEAR(sum, 1, 1e-12);
            EXPECT_NEAR(value, 3 * x - 2 * y, 1e-12);
        }
}

TEST(BilinearTexels, StayInTheMapForAllCoordinates) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const bool repeats : {false, true})
        for (const double x :
             {3e38, -3e38, 1e16 + 2, -1e-300, 3.0, kInfinity, -kInfinity, kInfinity - kInfinity})
            for (const double y : {x, 0.5}) {
                const BilinearTexels filter = bilinear_texels({3, 5, repeats}, x, y);
                for (int i = 0; i < 4; ++i) {
                    EXPECT_LT(filter.texels[i], 15u) << x << " " << y;
                    EXPECT_TRUE(filter.weights[i] >= 0 && filter.weights[i] <= 1) << x << " " << y;
                }
            }
    EXPECT_EQ(bilinear_texels({3, 3, true}, 9e15 + 1.5, 0.5).texels[0], 1u); // 9e15 is 3 times a whole number
}

TEST(BilinearTexels, EndAtTheBorderUnlessTheMapRepeats) {
    EXPECT_EQ(bilinear_texels({4, 4}, -3, 0.5).texels[0], 0u);
    EXPECT_EQ(bilinear_texels({4, 4}, 99, 3.5).texels[1], 15u);
    EXPECT_EQ(bilinear_texels({4, 4, true}, 0, 0.5).texels[0], 3u);
    EXPECT_EQ(bilinear_texels({4, 4, true}, 4.5, 0.5).texels[0], 0u);
}

TEST(NearestReceivers, AreTexelsAndTheirNeighbors) {
    const std::vector<std::uint32_t> texels = {0, 15};
    const std::vector<std::uint32_t> nearest = nearest_receivers({4, 4}, texels);
    for (std::uint32_t t = 0; t < 16; ++t) {
        const auto way = [&](std::uint32_t to) {
            return std::abs(static_cast<int>(t % 4) - static_cast<int>(to % 4)) +
                   std::abs(static_cast<int>(t / 4) - static_cast<int>(to / 4));
        };
        EXPECT_LE(way(texels[nearest[t]]), std::min(way(0), way(15))) << t;
    }
    EXPECT_EQ(nearest_receivers({2, 2}, {}), std::vector<std::uint32_t>(4, 0u));
}

TEST(LightmapEdges, JoinTexelsSideBySideAndSeams) {
    const LightmapLayout layout{{{3, 2}, {2, 1}}, {}};
    // x x .     and a second map x x
    // . x x
    const std::vector<std::uint32_t> texels = {0, 1, 4, 5, 6, 7};
    const std::vector<Edge> seams = {{0, 5}};
    EXPECT_EQ(lightmap_edges(layout, texels, seams),
              (std::vector<Edge>{{0, 1}, {0, 5}, {1, 2}, {2, 3}, {4, 5}}));
}

} // namespace
} // namespace prt
