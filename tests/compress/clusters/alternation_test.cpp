// Tests alternating optimisation: codes for given clusters, and clusters for given codes.

#include "compress/clusters/clustering.h"
#include "compress/coding/refit.h"
#include "compress/metric/frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace prt {
namespace {

/// Returns transfer with a spectrum like that of real transfer, without structure: clusters with few members
/// and many components.
Transfer falling_spectrum(std::size_t receivers, unsigned seed) {
    Transfer t = zero_transfer(4, 1, receivers);
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    for (std::size_t p = 0; p < receivers; ++p)
        for (std::size_t i = 0; i < t.dimension(); ++i)
            t.vector(p)[i] = normal(random) * std::pow(0.8f, static_cast<float>(i));
    return t;
}

TEST(Alternation, KeepsTheBestRound) {
    constexpr std::size_t kReceivers = 300;
    const std::vector<float> significance(kReceivers, 1.0f / kReceivers);
    for (const unsigned seed : {1u, 2u, 3u, 4u}) {
        const Transfer transfer = falling_spectrum(kReceivers, seed);
        const Frame frame = fit_frame(transfer, significance, plain_metric(layout_of_one(4, 1)), 0, 1);
        const PointBlocks points(transfer, frame, {}, 1);
        ClusteringOptions how;
        // the number of members is at most the number of unknowns of least squares
        how.clusters = kReceivers / 9;
        how.rate_budget.component_limit = 16;
        how.rate_budget.bits = 33;
        std::mt19937_64 random(seed);
        const Clustering found = cluster_points(points, significance, how, random, {});
        QuantisedClusters clusters = quantised_clusters(points, significance, found, WeightFormat::packed, 1);
        Codes codes;
        codes.clusters = found.clusters;
        encode_in_place(points, clusters, codes, 1);
        double before = total_error(significance, codes.errors);
        const double first = before;
        for (int round = 0; round < 6; ++round) {
            refit(points, significance, codes, clusters, 1);
            const Codes kept = codes;
            encode_points(points, clusters, neighbours_of_codes(clusters, 16, 1), codes, 1);
            keep_better(points, clusters, kept, codes, 1);
            const double error = total_error(significance, codes.errors);
            EXPECT_LE(error, before * (1 + 1e-5)) << "seed " << seed << ", round " << round;
            before = error;
        }
        EXPECT_LT(before, 0.9 * first); // and it finds something
    }
}

} // namespace
} // namespace prt
