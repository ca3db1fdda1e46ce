// Tests the baselines of the study.

#include "compress/study/baselines.h"

#include "prt/core/error_measures.h"

#include <gtest/gtest.h>

#include <random>

namespace prt {
namespace {

Transfer random_transfer(std::size_t receivers) {
    Transfer t = zero_transfer(3, 1, receivers);
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    for (float& v : t.vectors)
        v = normal(random);
    return t;
}

TEST(Baselines, TruncationKeepsItsBandsInEightBits) {
    const Transfer t = random_transfer(100);
    const BaselineResult r = truncated_sh(t, 2);
    EXPECT_EQ(r.payload_bytes, 4);
    for (std::size_t p = 0; p < 100; ++p)
        for (std::size_t i = 0; i < 9; ++i)
            EXPECT_NEAR(r.decoded.vector(p)[i], i < 4 ? t.vector(p)[i] : 0.0f, 4.0f / 127);
}

TEST(Baselines, WithAllComponentsHaveOnlyEightBitError) {
    const Transfer t = random_transfer(300);
    const std::vector<float> areas(300, 1.0f);
    const BaselineResult r = classic_cpca(t, areas, {.clusters = 1, .components = 9});
    EXPECT_LT(relative_l2(t, r.decoded, areas),
              0.01); // a step of 3.5 sigma / 127 along each of nine axes: 0.8 %
    EXPECT_GT(relative_l2(t, r.decoded, areas), 0.001);
    EXPECT_EQ(r.payload_bytes, 12); // nine bytes in whole words
    EXPECT_EQ(r.table_bytes, 10 * 9 * 2 + 9 * 4);
}

TEST(Baselines, CountBoundWords) {
    const Transfer t = random_transfer(600);
    const std::vector<float> areas(600, 1.0f);
    EXPECT_EQ(truncated_sh(t, 3).payload_bytes, 12);  // 9 bytes
    EXPECT_EQ(truncated_sh(t, 3).table_bytes, 9 * 4); // tables have no padding
    EXPECT_EQ(classic_cpca(t, areas, {.clusters = 1, .components = 4}).payload_bytes, 4);
    EXPECT_EQ(classic_cpca(t, areas, {.clusters = 8, .components = 3}).payload_bytes,
              4); // the cluster's byte and three weights
    EXPECT_EQ(classic_cpca(t, areas, {.clusters = 8, .components = 4}).payload_bytes, 8);
    EXPECT_EQ(classic_cpca(t, areas, {.clusters = 300, .components = 0}).payload_bytes,
              4); // two bytes of cluster
}

TEST(Baselines, IterationIsNotWorseThanSinglePca) {
    const Transfer t = random_transfer(500);
    const std::vector<float> areas(500, 1.0f);
    for (const int components : {1, 3, 5})
        EXPECT_LE(
            relative_l2(t, classic_cpca(t, areas, {.clusters = 8, .components = components}).decoded, areas),
            relative_l2(
                t,
                classic_cpca(t, areas, {.clusters = 8, .components = components, .iterate = false}).decoded,
                areas));
}

} // namespace
} // namespace prt
