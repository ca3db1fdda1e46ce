#include "prt/jumps.h"

#include "prt/support/error.h"

#include <gtest/gtest.h>

namespace prt {
namespace {

/// A hundred pairs of receivers of transfer 1; the second of pair i errs by i thousandths.
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
        return jump_across_clusters(reference, approximation, clusters, {areas, edges},
                                    plain_metric(reference.layout));
    }
};

TEST(Jumps, AreThe99thPercentileByArea) {
    Pairs pairs;
    for (const std::size_t p : {198, 199}) // a hundredth of all is 1.99: this pair, and half of the next
        pairs.areas[p] = 0.5f;
    EXPECT_NEAR(pairs.jump(), 0.098, 1e-6);
    for (const std::size_t p : {198, 199}) // 2.08, less than this pair alone
        pairs.areas[p] = 5;
    EXPECT_NEAR(pairs.jump(), 0.099, 1e-6);
}

TEST(Jumps, InsideClustersAndOfWhatBothEndsShareDoNotCount) {
    Pairs pairs;
    pairs.edges.push_back({0, 198}); // both of cluster 0
    pairs.approximation.vector(198)[0] = 9;
    pairs.approximation.vector(199)[0] = 9; // this pair errs together
    EXPECT_NEAR(pairs.jump(), 0.097, 1e-6);
    pairs.clusters.assign(pairs.clusters.size(), 3);
    EXPECT_EQ(pairs.jump(), 0);
}

TEST(Jumps, RefuseTransfersThatDoNotBelongTogether) {
    Pairs pairs;
    pairs.clusters.pop_back();
    EXPECT_THROW(pairs.jump(), Error);
}

} // namespace
} // namespace prt
