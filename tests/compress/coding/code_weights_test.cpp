// Tests packing of weights with the bits of their grids: it is lossless, and does not change other weights.

#include "compress/coding/code_weights.h"

#include <gtest/gtest.h>

#include <random>

namespace prt {
namespace {

/// Returns clusters with 0 to `most` components on grids returned by `grid(random)`.
template <class Grid>
QuantisedClusters some_clusters(std::size_t most, std::mt19937& random, Grid&& grid) {
    QuantisedClusters clusters{AffineClusters(most + 1, 1, most), {}};
    for (std::size_t k = 0; k <= most; ++k) {
        clusters.components[k] = static_cast<int>(k);
        for (std::size_t j = 0; j < most; ++j)
            clusters.grids.push_back(grid(random));
    }
    return clusters;
}

void expect_kept(const QuantisedClusters& clusters, std::mt19937& random) {
    constexpr std::size_t kPoints = 500;
    CodeWeights weights(kPoints, clusters);
    std::vector<std::vector<float>> written(kPoints);
    std::vector<std::size_t> cluster(kPoints);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int rotation = 0; rotation < 2; ++rotation) // the second time in other clusters
        for (std::size_t p = 0; p < kPoints; ++p) {
            cluster[p] = random() % clusters.clusters();
            written[p].clear();
            for (std::size_t j = 0; j < clusters.components_of(cluster[p]); ++j)
                written[p].push_back(clusters.grid(cluster[p], j).nearest(p % 7 ? unit(random) : 1.0f));
            weights.write(clusters, cluster[p], p, written[p].data());
        }
    CodeWeights copy(kPoints, clusters);
    for (std::size_t p = 0; p < kPoints; ++p)
        copy.copy(weights, p);
    for (const CodeWeights& of : {weights, copy})
        for (std::size_t p = 0; p < kPoints; ++p) {
            std::vector<float> read(written[p].size());
            of.read(clusters, cluster[p], p, read.data());
            EXPECT_EQ(read, written[p]) << p;
        }
}

TEST(CodeWeights, KeepGridValuesExactly) {
    std::mt19937 random(1);
    expect_kept(
        some_clusters(9, random,
                      [](std::mt19937& r) { return WeightGrid::of_bits(1 + static_cast<int>(r() % 16)); }),
        random);
}

TEST(CodeWeights, KeepFloatsWithoutQuantization) {
    std::mt19937 random(2);
    expect_kept(some_clusters(6, random, [](std::mt19937&) { return WeightGrid::any(); }), random);
}

} // namespace
} // namespace prt
