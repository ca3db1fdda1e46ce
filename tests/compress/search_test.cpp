#include "prt/search.h"

#include "prt/baselines.h"
#include "prt/error.h"
#include "prt/error_measures.h"

#include <gtest/gtest.h>

#include <random>

namespace prt {
namespace {

/// Something like transfer: smooth functions of two parameters with a crease, and a little noise.
Transfer smooth_transfer(std::size_t receivers, int channels, unsigned seed) {
    Transfer t = zero_transfer(4, channels, receivers);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<float> frequencies(3 * t.dimension());
    for (float& f : frequencies)
        f = 3 * uniform(random);
    for (std::size_t p = 0; p < receivers; ++p) {
        const float u = uniform(random), v = uniform(random);
        for (std::size_t i = 0; i < t.dimension(); ++i)
            t.vector(p)[i] =
                (i == 0 ? 1.0f : 0.3f) *
                    std::sin(frequencies[3 * i] * u + frequencies[3 * i + 1] * v + frequencies[3 * i + 2]) *
                    (u > 0.2f ? 1.0f : 0.4f) +
                0.002f * uniform(random);
    }
    return t;
}

struct Tried {
    Transfer transfer;
    std::vector<float> areas;

    Tried(std::size_t receivers, int channels, unsigned seed)
        : transfer(smooth_transfer(receivers, channels, seed)), areas(receivers, 1.0f) {}
    SearchResult within(const Budget& budget, WeightFormat format = WeightFormat::packed) const {
        SearchOptions options;
        options.budget = budget;
        options.compress.weights = format;
        return compress_within(transfer, areas, {}, options);
    }
    double lit_rms(const CompressResult& result) const {
        return expected_lit_rms(transfer, decode(result.transfer), areas,
                                natural_metric(4, transfer.channels));
    }
};

TEST(Search, KeepsTheErrorThatWasAskedFor) {
    const Tried scene(700, 1, 1);
    for (const double error : {0.1, 0.01}) {
        const SearchResult found = scene.within({error, {}, {}});
        EXPECT_TRUE(found.kept);
        EXPECT_LE(scene.lit_rms(found.result), error);
        EXPECT_GT(scene.lit_rms(found.result), 0.5 * error); // and spends no more than it needs
    }
}

TEST(Search, KeepsTheBytesThatWereAskedFor) {
    const Tried scene(700, 3, 2);
    for (const double bytes : {6.0, 12.5}) {
        const SearchResult found = scene.within({{}, bytes, {}});
        EXPECT_TRUE(found.kept);
        EXPECT_LE(found.result.statistics.bytes_with_bases(700), bytes);
        EXPECT_GT(found.result.statistics.bytes_with_bases(700), 0.85 * bytes);
    }
}

TEST(Search, KeepsTheOperationsThatWereAskedFor) {
    const Tried scene(600, 1, 3);
    for (const double ops : {0.5, 3.0}) {
        const SearchResult found = scene.within({{}, {}, ops});
        EXPECT_TRUE(found.kept);
        EXPECT_LE(found.result.statistics.mean_components, ops);
        EXPECT_GT(found.result.statistics.mean_components, 0.6 * ops);
    }
}

TEST(Search, KeepsThreePromisesAtOnceOrSaysThatItCannot) {
    const Tried scene(600, 1, 4);
    const SearchResult loose = scene.within({0.05, 12.0, 8.0});
    EXPECT_TRUE(loose.kept);
    EXPECT_LE(loose.result.statistics.lit_rms, 0.05);
    EXPECT_LE(loose.result.statistics.bytes_with_bases(600), 12);
    EXPECT_LE(loose.result.statistics.mean_components, 8);
    const SearchResult tight = scene.within({1e-4, 1.5, {}});
    EXPECT_FALSE(tight.kept);
    EXPECT_GT(tight.result.transfer.receivers.size(), 0u); // the nearest there is
}

TEST(Search, OtherFormatsKeepPromisesToo) {
    const Tried scene(500, 1, 5);
    const SearchResult found = scene.within({0.03, {}, {}}, WeightFormat::snorm8);
    EXPECT_TRUE(found.kept);
    EXPECT_EQ(found.result.transfer.receivers.format, WeightFormat::snorm8);
    EXPECT_LE(scene.lit_rms(found.result), 0.03);
}

TEST(Search, IsMonotoneInEveryBudget) {
    const Tried scene(600, 1, 6);
    double before = 1e9;
    for (const double bytes : {3.0, 6.0, 12.0}) {
        const double error = scene.within({{}, bytes, {}}).result.statistics.lit_rms;
        EXPECT_LT(error, before);
        before = error;
    }
    before = 0;
    for (const double error : {0.1, 0.01}) {
        const double bytes = scene.within({error, {}, {}}).result.statistics.bytes_with_bases(600);
        EXPECT_GT(bytes, before);
        before = bytes;
    }
    before = 1e9;
    for (const double ops : {1.0, 4.0}) {
        const double error = scene.within({{}, {}, ops}).result.statistics.lit_rms;
        EXPECT_LT(error, before);
        before = error;
    }
}

TEST(Search, IsNeverWorseThanTheMethodsItComesFromAtTheirSize) {
    for (const unsigned seed : {11u, 13u}) {
        const int channels = seed == 13 ? 3 : 1;
        const Tried scene(600, channels, seed);
        const LightMetric metric = natural_metric(4, channels);
        for (const auto& [clusters, components] : {std::pair(1, 6), std::pair(64, 0), std::pair(16, 2)}) {
            const BaselineResult other = classic_cpca(scene.transfer, scene.areas, {clusters, components});
            const double bytes = other.payload_bytes + other.table_bytes / 600;
            const double error = expected_lit_rms(scene.transfer, other.decoded, scene.areas, metric);
            const SearchResult ours = scene.within({{}, bytes, {}});
            EXPECT_TRUE(ours.kept);
            EXPECT_LT(ours.result.statistics.lit_rms, error) << clusters << " x " << components;
        }
    }
}

TEST(Search, RefusesBudgetsThatMakeNoSense) {
    const Tried scene(50, 1, 1);
    EXPECT_THROW(scene.within({}), Error);
    EXPECT_THROW(scene.within({0.0, {}, {}}), Error);
    EXPECT_THROW(scene.within({{}, -1.0, {}}), Error);
    EXPECT_THROW(scene.within({{}, {}, std::nan("")}), Error);
}

} // namespace
} // namespace prt
