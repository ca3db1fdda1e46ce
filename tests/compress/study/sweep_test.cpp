// Tests sweeps over compression settings.

#include "compress/study/sweep.h"

#include <gtest/gtest.h>

#include <cmath>

namespace prt {
namespace {

/// Returns transfer that rotates along a strip of 500 receivers: two dimensions of it are smooth, the rest is
/// small.
Transfer strip() {
    Transfer t = zero_transfer(2, 1, 500);
    for (std::size_t p = 0; p < t.receivers(); ++p) {
        const float u = static_cast<float>(p) / 500;
        t.vector(p)[0] = 1 + 0.4f * std::sin(9 * u);
        t.vector(p)[1] = std::cos(7 * u);
        t.vector(p)[2] = 0.3f * std::sin(40 * u);
        t.vector(p)[3] = 0.1f * std::cos(90 * u);
    }
    return t;
}

/// Codes `transfer` as `factor` times itself, in 3 bytes and with 2 components.
SweepCandidate scaled(const Transfer& transfer, const char* method, float factor) {
    return {method, [&transfer, factor](const Progress&) {
                CandidateResult result{"as is", {transfer, 3, 0, 2}};
                for (float& v : result.coded.decoded.vectors)
                    v *= factor;
                return result;
            }};
}

TEST(Sweep, MeasuresEveryMethodAndOursIsNotWorse) {
    const Transfer transfer = strip();
    const std::vector<float> areas(transfer.receivers(), 1.0f);
    std::vector<glm::vec3> positions;
    for (std::size_t p = 0; p < transfer.receivers(); ++p)
        positions.push_back({static_cast<float>(p) / 500, 0, 0});
    const std::vector<Light> lights = {constant_light(2, {1, 1, 1}),
                                       directional_light(2, {0, 1, 0}, {2, 1, 1})};
    std::vector<SweepCandidate> others = {scaled(transfer, "half", 0.5f), scaled(transfer, "third", 1 / 3.0f),
                                          scaled(transfer, "quarter", 0.25f)};
    others[1].tables = SweepTables::by_bytes;
    others[2].tables = SweepTables::by_components;
    others.push_back({"no code", [](const Progress&) { return std::nullopt; }});
    double shown = 0;
    const Progress progress{[&](double share) { // the bar does not run backwards meanwhile
                                EXPECT_GE(share, shown - 1e-12);
                                EXPECT_LE(share, 1);
                                shown = share;
                            },
                            {}};
    const Sweep result =
        sweep(transfer, {.areas = areas, .positions = positions}, lights, {}, others, progress);
    EXPECT_GT(shown, 0.75);

    const SweepPoint* half = best_by_bytes(result, "half", 3);
    ASSERT_NE(half, nullptr);
    EXPECT_NEAR(half->relative_l2, 0.5, 1e-6); // half of everything is missing
    EXPECT_NEAR(half->lit_rms, 0.5, 1e-6);
    EXPECT_EQ(best_by_bytes(result, "half", 2.9), nullptr);
    EXPECT_NE(best_by_components(result, "half", 2), nullptr);
    EXPECT_EQ(half->setting, "as is");
    EXPECT_NE(best_by_bytes(result, "third", 3), nullptr);
    EXPECT_EQ(best_by_components(result, "third", 2), nullptr);
    EXPECT_EQ(best_by_bytes(result, "quarter", 3), nullptr);
    EXPECT_NE(best_by_components(result, "quarter", 2), nullptr);
    EXPECT_EQ(best_by_bytes(result, "no code", 100), nullptr);

    for (const char* method : {"truncated SH", "plain PCA", "static CPCA", "vector quantisation", kClassic})
        EXPECT_NE(best_by_bytes(result, method, 100), nullptr) << method;
    for (const double bytes : kSweepBytes) {
        const SweepPoint* ours = best_by_bytes(result, kOurs, bytes);
        ASSERT_NE(ours, nullptr) << bytes;
        EXPECT_LE(ours->bytes(), bytes);
        const SweepPoint* classic = best_by_bytes(result, kClassic, bytes);
        EXPECT_TRUE(!classic || ours->lit_rms <= classic->lit_rms) << bytes;
    }
    for (const SweepPoint& point : result.by_components)
        if (point.method == kOurs) {
            const SweepPoint* classic =
                best_by_components(result, kClassic, std::ceil(point.mean_components));
            ASSERT_NE(classic, nullptr);
            EXPECT_LE(point.bytes(), classic->bytes());
        }
}

TEST(Sweep, MeasuresJumpsAlongAllEdges) {
    // Every other receiver is a quarter too bright: every edge jumps by that, in each of the two lights.
    const std::size_t count = 12;
    Transfer transfer = zero_transfer(1, 1, count), uneven = transfer;
    std::vector<Edge> edges;
    for (std::size_t p = 0; p < count; ++p) {
        transfer.vector(p)[0] = 1;
        uneven.vector(p)[0] = p % 2 == 0 ? 1.25f : 1.0f;
        if (p > 0)
            edges.push_back({static_cast<std::uint32_t>(p - 1), static_cast<std::uint32_t>(p)});
    }
    const std::vector<float> areas(count, 1.0f);
    const std::vector<Light> lights = {constant_light(1, {1, 1, 1}), constant_light(1, {8, 8, 8})};
    const std::vector<SweepCandidate> others = {{"uneven",
                                                 [&](const Progress&) {
                                                     return CandidateResult{"", {uneven, 0, 0, 0}};
                                                 }},
                                                // by an equal factor everywhere
                                                scaled(transfer, "bright", 1.25f)};
    const Sweep result = sweep(transfer, {areas, edges}, lights, {}, others);
    EXPECT_NEAR(best_by_bytes(result, "uneven", 0)->jumps, 0.25, 1e-6);
    EXPECT_NEAR(best_by_bytes(result, "bright", 3)->jumps, 0, 1e-6);
    EXPECT_NEAR(best_by_bytes(result, "bright", 3)->lit_rms, 0.25, 1e-6);
}

TEST(Sweep, ReportsMissingRowsForFewReceivers) {
    constexpr std::size_t kReceivers = 20; // no bases fit five bytes
    Transfer few = zero_transfer(2, 1, kReceivers);
    std::copy_n(strip().vectors.begin(), few.vectors.size(), few.vectors.begin());
    const std::vector<Light> lights = {constant_light(2, {1, 1, 1})};
    const Sweep result = sweep(few, {std::vector<float>(kReceivers, 1.0f)}, lights, {});
    std::size_t ours = 0, asked = std::size(kSweepBytes), clustered = 0;
    for (const auto* points : {&result.by_bytes, &result.by_components})
        for (const SweepPoint& point : *points) {
            ours += point.method == kOurs;
            asked += points == &result.by_components && point.method == kClassic;
            if (point.method == "static CPCA" || point.method == kClassic ||
                point.method == "vector quantisation") {
                EXPECT_LE(std::stoi(point.setting), 2) << point.setting;
                ++clustered;
            }
        }
    EXPECT_LT(ours, asked);
    EXPECT_EQ(ours + result.left_out.size(), asked);
    EXPECT_GT(clustered, 6u);
}

} // namespace
} // namespace prt
