// Tests that the trace explains the result, and does not change it.

#include "prt/compress/search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace prt {
namespace {

/// Returns curved sheets of different sizes, so that vector quantisation starts with too many clusters on
/// some.
Transfer curved_sheets(std::size_t receivers) {
    Transfer t = zero_transfer(3, 1, receivers);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (std::size_t p = 0; p < receivers; ++p) {
        const float u = uniform(random), v = uniform(random), size = p % 5 == 0 ? 3.0f : 0.5f;
        for (std::size_t i = 0; i < t.dimension(); ++i)
            t.vector(p)[i] = size * std::sin(static_cast<float>(1 + i % 3) * u + static_cast<float>(i) * v) +
                             0.01f * uniform(random);
    }
    return t;
}

template <class Event>
std::vector<Event> those_of(const std::vector<CompressEvent>& events) {
    std::vector<Event> found;
    for (const CompressEvent& event : events)
        if (const Event* one = std::get_if<Event>(&event))
            found.push_back(*one);
    return found;
}

/// Returns the mean of Y² / (Y + a)² under natural light with equal weights of receivers: the weight of
/// squared light if errors count by contrast (docs/math.md, eq. 28c).
double light_seen(const Transfer& t) {
    const LightMetric metric = natural_metric(t.layout);
    const std::size_t n = t.dimension();
    std::vector<double> luminance;
    double logarithms = 0;
    for (std::size_t p = 0; p < t.receivers(); ++p) {
        double square = 0;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j)
                square += static_cast<double>(t.vector(p)[i]) * metric.moments[i * n + j] *
                          static_cast<double>(t.vector(p)[j]);
        luminance.push_back(std::sqrt(square));
        logarithms += std::log(luminance.back()) / static_cast<double>(t.receivers());
    }
    const double a = 0.1 * std::exp(logarithms);
    double sum = 0;
    for (const double y : luminance)
        sum += y * y / ((y + a) * (y + a)) / static_cast<double>(t.receivers());
    return sum;
}

TEST(Trace, RecordsTheSteps) {
    const Transfer t = curved_sheets(1200);
    const std::vector<float> areas(t.receivers(), 1.0f);
    CompressOptions options{.clusters = 24, .coding = {.components = 3}};
    const CompressResult without = compress(t, {areas}, options);
    std::vector<CompressEvent> events;
    options.trace = [&](const CompressEvent& event) { events.push_back(event); };
    const CompressResult with = compress(t, {areas}, options);

    EXPECT_EQ(with.transfer.bases.rows, without.transfer.bases.rows);
    EXPECT_EQ(with.transfer.receivers.weights, without.transfer.receivers.weights);

    ASSERT_TRUE(std::holds_alternative<ClustersSeeded>(events.front()));
    EXPECT_EQ(std::get<ClustersSeeded>(events.front()).clusters, 24u);
    // Merges and splits come in pairs; a sweep is kept exactly if it lowers the cost.
    std::size_t splits = 0, merges = 0, emptied = 0;
    for (const CompressEvent& event : events) {
        if (const auto* merge = std::get_if<ClusterMerge>(&event)) {
            ++merges;
            emptied = merge->cluster;
        } else if (const auto* split = std::get_if<ClusterSplit>(&event)) {
            ++splits;
            EXPECT_EQ(split->into, emptied);
            EXPECT_GT(split->gain, 0);
        } else if (const auto* moves = std::get_if<MovesTried>(&event)) {
            EXPECT_GT(splits, 0u);
            EXPECT_EQ(splits, merges);
            EXPECT_TRUE(!moves->kept || moves->cost_after < moves->cost_before);
            splits = merges = 0;
        }
    }
    EXPECT_EQ(splits, 0u); // every one belongs to a sweep
    EXPECT_FALSE(those_of<MovesTried>(events).empty());

    const std::vector<ClusteringRound> rounds = those_of<ClusteringRound>(events);
    ASSERT_GT(rounds.size(), 2u);
    EXPECT_LT(rounds.back().cost, rounds.front().cost);
    double least = 1;
    for (const CodingRound& round : those_of<CodingRound>(events))
        if (round.rounded)
            least = std::min(least, round.error);
    constexpr double kShare = 0.3; // fraction of contrast in the cost
    const double lit = with.statistics.lit_rms, contrast = with.statistics.sky_contrast,
                 cost = std::sqrt(((1 - kShare) * lit * lit + kShare * contrast * contrast) /
                                  (1 - kShare + kShare * light_seen(t)));
    EXPECT_NEAR(std::sqrt(least), cost, 0.02 * cost);
}

/// A cluster may be cheap to merge and also gain by a split, if some receivers have little weight.
TEST(Trace, NoClusterMovesTwiceInASweep) {
    const Transfer t = curved_sheets(600);
    std::vector<float> areas(t.receivers(), 1.0f);
    for (std::size_t p = 0; p < areas.size(); p += 3)
        areas[p] = 1e-3f;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        CompressOptions options{.clusters = 40, .coding = {.components = 2}};
        options.seed = seed;
        std::multiset<std::size_t> touched;
        options.trace = [&](const CompressEvent& event) {
            if (const auto* merge = std::get_if<ClusterMerge>(&event))
                touched.insert({merge->cluster, merge->into});
            else if (const auto* split = std::get_if<ClusterSplit>(&event))
                touched.insert(split->cluster);
            else if (std::holds_alternative<MovesTried>(event)) {
                for (const std::size_t cluster : touched)
                    EXPECT_EQ(touched.count(cluster), 1u) << "seed " << seed;
                touched.clear();
            }
        };
        compress(t, {areas}, options);
    }
}

TEST(Trace, RecordsEveryTrialOfASearch) {
    const Transfer t = curved_sheets(300);
    std::vector<CompressEvent> events;
    SearchOptions options;
    options.budget.bytes_per_vertex = 10;
    options.compress.trace = [&](const CompressEvent& event) { events.push_back(event); };
    const SearchResult found = compress_within(t, {std::vector<float>(300, 1.0f)}, options);
    const std::vector<SearchTrial> trials = those_of<SearchTrial>(events);
    ASSERT_EQ(trials.size(), found.trials.size());
    for (std::size_t i = 0; i < trials.size(); ++i)
        EXPECT_EQ(trials[i].lit_rms, found.trials[i].lit_rms);
}

TEST(Trace, NoBarRunsBackwards) {
    const Transfer sheets = curved_sheets(300), few = curved_sheets(80);
    const std::vector<float> areas(300, 1.0f);
    double shown = 0;
    const Progress progress{[&](double share) {
                                EXPECT_GE(share, shown - 1e-12);
                                EXPECT_LE(share, 1);
                                shown = share;
                            },
                            {}};
    // A preset whose bases are too large for so few receivers: the search continues in the progress bar.
    const CompressOptions options{.clusters = 256, .coding = preset_u32()};
    EXPECT_FALSE(compress_preset(sheets, {areas}, options, progress).trials.empty());
    EXPECT_EQ(shown, 1);
    shown = 0;
    SearchOptions search;
    search.budget.bytes_per_vertex = 10;
    EXPECT_GT(compress_within(few, {std::span(areas).first(80)}, search, progress).trials.size(), 1u);
}

} // namespace
} // namespace prt
