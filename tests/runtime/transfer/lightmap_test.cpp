// Lightmaps in memory: which texels filters read, and the pass that lights them.

#include "prt/core/cluster_lighting.h"
#include "prt/core/lightmap.h"
#include "runtime/transfer/texel_formats.h"
#include "support/random_lightmap.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

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

class Formats : public testing::TestWithParam<LightmapFormat> {};
INSTANTIATE_TEST_SUITE_P(All, Formats,
                         testing::Values(LightmapFormat::rgb9e5, LightmapFormat::r11g11b10,
                                         LightmapFormat::rgba16));

/// Returns the maximum error of one color; relative to the largest color if it determines the exponent.
float largest_error(LightmapFormat format, const glm::vec3& truth, int color) {
    const float largest = std::max({truth.r, truth.g, truth.b, 0x1p-15f});
    const float own = std::max(truth[color], 0x1p-14f);
    if (format == LightmapFormat::rgb9e5)
        return largest * 0x1p-9f;
    if (format == LightmapFormat::rgba16)
        return own * 0x1p-11f;
    return own * (color == 2 ? 0x1p-6f : 0x1p-7f);
}

/// One cluster for each color, without weights: a texel contains the constant, to the bit.
struct Palette {
    CompressedLightmap lightmap;
    std::vector<glm::vec4> constants;

    explicit Palette(const std::vector<glm::vec3>& colors) {
        lightmap.layout.maps = {{static_cast<int>(colors.size()), 1}};
        ClusteredTransfer& t = lightmap.compressed.transfer;
        t.bases.layout = layout_of_one(1, 1);
        t.bases.components.assign(colors.size(), 0);
        t.bases.rows.resize(colors.size());
        t.receivers.format = WeightFormat::packed;
        t.receivers.cluster_bits = 16;
        t.receivers.words = 1;
        t.receivers.weights.resize(4 * colors.size());
        for (std::size_t k = 0; k < colors.size(); ++k) {
            const auto word = static_cast<std::uint32_t>(k);
            std::memcpy(&t.receivers.weights[4 * k], &word, sizeof word);
            constants.emplace_back(colors[k], 0);
        }
    }
    std::vector<glm::vec3> stored(LightmapFormat format) const {
        const LightmapRelighter relighter(lightmap, format);
        std::vector<std::byte> texels(relighter.bytes(0));
        relighter.update(0, constants, texels, 1);
        std::vector<glm::vec3> colors;
        for (std::size_t i = 0; i < constants.size(); ++i)
            colors.push_back(read_texel(format, &texels[i * bytes_per_texel(format)]));
        return colors;
    }
};

TEST_P(Formats, RoundRadianceCorrectly) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> exponent(-12, 15);
    std::vector<glm::vec3> colors;
    for (int i = 0; i < 3000; ++i)
        colors.emplace_back(std::exp2(exponent(random)), std::exp2(exponent(random)),
                            std::exp2(exponent(random)));
    colors.insert(colors.end(), {{0, 0, 0}, {1, 1, 1}, {0.5f, 0.25f, 2}});
    const std::vector<glm::vec3> stored = Palette(colors).stored(GetParam());
    for (std::size_t i = 0; i < colors.size(); ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(stored[i][c], colors[i][c], largest_error(GetParam(), colors[i], c)) << i << " " << c;
    EXPECT_EQ(stored[3001], glm::vec3(1)); // powers of two exactly
    EXPECT_EQ(stored[3002], glm::vec3(0.5f, 0.25f, 2));
}

TEST_P(Formats, ClampNegativeAndInfiniteValues) {
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<glm::vec3> stored =
        Palette({{-1, 2, -infinity}, {infinity, 1e30f, 70000}, {std::nanf(""), 0, 0}}).stored(GetParam());
    EXPECT_EQ(stored[0].r, 0);
    EXPECT_EQ(stored[0].b, 0);
    for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(std::isfinite(stored[1][c]));
        EXPECT_GT(stored[1][c], 64000);
    }
    EXPECT_EQ(stored[2], glm::vec3(0));
}

TEST_P(Formats, MipLevelsAreMeans) {
    std::mt19937 random(3);
    for (const LightmapSize& size : {LightmapSize{130, 66}, {1, 1}, {1, 9}, {5, 3}, {200, 1}}) {
        const CompressedLightmap lightmap = test::random_lightmap({size}, 1, false, random);
        const ClusterLighting constants(lightmap.compressed.transfer);
        std::vector<glm::vec4> computed(constants.rows());
        for (glm::vec4& c : computed)
            c = glm::vec4(1 + static_cast<float>(random() % 100) / 1000, 1, 1, 0); // times any q
        const LightmapRelighter relighter(lightmap, GetParam());
        std::vector<std::byte> texels(relighter.bytes(0));
        relighter.update(0, computed, texels, 2);
        const auto at = [&](const LightmapLevel& level, int x, int y) {
            const auto index = static_cast<std::size_t>(y * level.width + x);
            return read_texel(GetParam(), &texels[level.first + index * bytes_per_texel(GetParam())]);
        };
        const auto levels = relighter.levels(0);
        EXPECT_EQ(levels.back().width * levels.back().height, 1);
        for (std::size_t l = 1; l < levels.size(); ++l)
            for (int y = 0; y < levels[l].height; ++y)
                for (int x = 0; x < levels[l].width; ++x) {
                    const LightmapLevel& from = levels[l - 1];
                    const int right = std::min(2 * x + 1, from.width - 1),
                              low = std::min(2 * y + 1, from.height - 1);
                    const glm::vec3 mean = 0.25f * (at(from, 2 * x, 2 * y) + at(from, right, 2 * y) +
                                                    at(from, 2 * x, low) + at(from, right, low));
                    for (int c = 0; c < 3; ++c) // the first level is computed from unrounded values
                        EXPECT_NEAR(at(levels[l], x, y)[c], mean[c], 3 * largest_error(GetParam(), mean, c));
                }
    }
}

TEST_P(Formats, MatchEvaluation) {
    std::mt19937 random(8);
    const CompressedLightmap lightmap = test::random_lightmap({{67, 5}, {9, 33}}, 2, false, random);
    const ClusterLighting constants(lightmap.compressed.transfer);
    std::vector<glm::vec4> computed(constants.rows());
    Light light = constant_light(3, glm::vec3(2, 1, 0.5f));
    constants.update(light, computed);
    std::vector<glm::vec3> expected(lightmap.layout.texels());
    evaluate(lightmap.compressed.transfer, computed, expected);
    const LightmapRelighter relighter(lightmap, GetParam());
    for (std::size_t m = 0; m < 2; ++m) {
        std::vector<std::byte> whole(relighter.bytes(m)), pieces = whole;
        relighter.update(m, computed, whole);
        const int height = lightmap.layout.maps[m].height;
        for (int y = 0; y < height; y += 2)
            relighter.update_rows(m, computed, y, std::min(height, y + 2), pieces);
        relighter.update_smaller_levels(m, pieces);
        EXPECT_EQ(whole, pieces);
        for (std::size_t t = 0; t < lightmap.layout.maps[m].texels(); ++t) {
            const glm::vec3 truth = glm::max(expected[lightmap.layout.first_texels()[m] + t], glm::vec3(0));
            const glm::vec3 stored = read_texel(GetParam(), &whole[t * bytes_per_texel(GetParam())]);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(stored[c], truth[c], largest_error(GetParam(), truth, c));
        }
    }
}

} // namespace
} // namespace prt
