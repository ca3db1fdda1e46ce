// Tests jumps of contrast between neighbouring receivers.

#include "compress/metric/jumps.h"

#include "prt/core/error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace prt {
namespace {

/// A hundred pairs of receivers of transfer 1; the second receiver of pair i has an error of i thousandths.
/// All are equal, so eyes adapt to a tenth of their light, and contrast is the error over 1.1.
struct Pairs {
    static constexpr std::uint32_t kCount = 100;
    Transfer reference = zero_transfer(1, 1, 2 * kCount), approximation = reference;
    std::vector<std::uint16_t> clusters;
    std::vector<float> areas = std::vector<float>(2 * kCount, 1.0f);
    std::vector<Edge> edges;

    Pairs() {
        for (std::uint32_t p = 0; p < 2 * kCount; ++p) {
            const std::uint32_t pair = p / 2;
            reference.vector(p)[0] = 1;
            approximation.vector(p)[0] = p % 2 ? 1 + 0.001f * static_cast<float>(pair) : 1.0f;
            clusters.push_back(static_cast<std::uint16_t>(p % 2));
        }
        for (std::uint32_t i = 0; i < kCount; ++i)
            edges.push_back({2 * i, 2 * i + 1});
    }
    double jump() const {
        return ClusterJumps(reference, {areas, edges}, plain_metric(reference.layout))
            .percentile_99(approximation, clusters);
    }
};

TEST(Jumps, AreThe99thPercentileByArea) {
    Pairs pairs;
    for (const std::size_t p : {198, 199}) // a hundredth of all is 1.99: this pair, and half of the next
        pairs.areas[p] = 0.5f;
    EXPECT_NEAR(pairs.jump(), 0.098 / 1.1, 1e-6);
    for (const std::size_t p : {198, 199}) // 2.08, less than this pair alone
        pairs.areas[p] = 5;
    EXPECT_NEAR(pairs.jump(), 0.099 / 1.1, 1e-6);
}

TEST(Jumps, IgnoreEdgesInsideClustersAndSharedErrors) {
    Pairs pairs;
    pairs.edges.push_back({0, 198}); // both of cluster 0
    pairs.approximation.vector(198)[0] = 9;
    pairs.approximation.vector(199)[0] = 9; // this pair errs together
    EXPECT_NEAR(pairs.jump(), 0.097 / 1.1, 1e-6);
    pairs.clusters.assign(pairs.clusters.size(), 3);
    EXPECT_EQ(pairs.jump(), 0);
}

/// Pairs whose errors are along X: light from X increases the error, and reduces the mean when it is rotated
/// away.
TEST(Jumps, UnderSkiesUseTheWorstSkyAndRotation) {
    Pairs pairs;
    const auto along_x = [](const Transfer& from) {
        Transfer to = zero_transfer(2, 1, from.receivers());
        for (std::size_t p = 0; p < from.receivers(); ++p) {
            to.vector(p)[0] = 1;
            to.vector(p)[3] = from.vector(p)[0];
        }
        return to;
    };
    const Transfer reference = along_x(pairs.reference), approximation = along_x(pairs.approximation);
    const auto light = [](float constant, float x) {
        Light result{2, std::vector<glm::vec3>(4, glm::vec3(0))};
        result.coefficients[0] = glm::vec3(constant, 0, 0);
        result.coefficients[3] = glm::vec3(x, 0, 0);
        return Lighting{result};
    };
    const auto jump = [&](const std::vector<Lighting>& skies) {
        return ClusterJumps(reference, {pairs.areas, pairs.edges}, skies)
            .percentile_99(approximation, pairs.clusters);
    };
    // Jumps of 98 thousandths along X: 0.098 x / 1.1 |constant + x|, largest with x against the constant.
    EXPECT_NEAR(jump({light(3, 1)}), 0.098 / 2.2, 1e-5);
    EXPECT_NEAR(jump({light(5, 1), light(3, 1), light(4, 1)}), 0.098 / 2.2, 1e-5);
    EXPECT_NEAR(jump({light(1, 0)}), 0, 1e-6);
    EXPECT_EQ(jump({light(0, 0)}), 0); // dark
}

/// With an equal error at less light, the 99th percentile is the pair of dark receivers.
TEST(Jumps, AreRelativeToTheLightOfTheirReceivers) {
    Pairs pairs;
    for (const std::uint32_t p : {100u, 101u, 102u, 103u}) // errors of 0.050 and 0.051
        for (Transfer* transfer : {&pairs.reference, &pairs.approximation})
            transfer->vector(p)[0] -= 0.9f;
    const double adaptation = 0.1 * std::pow(0.1, 4.0 / 200);
    EXPECT_NEAR(pairs.jump(), 0.050 / (0.1 + adaptation), 1e-6);
}

TEST(Jumps, RejectMismatchedTransfers) {
    Pairs pairs;
    pairs.clusters.pop_back();
    EXPECT_THROW(pairs.jump(), Error);
}

} // namespace
} // namespace prt
