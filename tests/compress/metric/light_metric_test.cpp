// Tests metrics of lights against brute force.

#include "prt/compress/light_metric.h"

#include "prt/core/error.h"
#include "prt/core/error_measures.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

namespace prt {
namespace {

Transfer random_transfer(std::size_t receivers, const TransferLayout& layout, unsigned seed) {
    Transfer t = zero_transfer(layout, receivers);
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    for (float& v : t.vectors)
        v = normal(random);
    return t;
}

Transfer random_transfer(std::size_t receivers, int order, int channels, unsigned seed) {
    return random_transfer(receivers, layout_of_one(order, channels), seed);
}

/// Sums of squared errors and of squared radiance with equal weights of receivers, light by light.
struct LitSums {
    double error = 0, norm = 0;

    void add(std::span<const glm::vec3> wanted, std::span<const glm::vec3> found, double weight = 1) {
        for (std::size_t p = 0; p < wanted.size(); ++p) {
            error += weight * static_cast<double>(glm::dot(wanted[p] - found[p], wanted[p] - found[p]));
            norm += weight * static_cast<double>(glm::dot(wanted[p], wanted[p]));
        }
    }
    double rms() const { return std::sqrt(error / norm); }
};

Light random_light(int order, std::mt19937& random) {
    std::normal_distribution<float> normal;
    Light light{order, {}};
    for (int i = 0; i < order * order; ++i)
        light.coefficients.emplace_back(normal(random), normal(random), normal(random));
    return light;
}

class Metric : public testing::TestWithParam<int> {}; // channels
INSTANTIATE_TEST_SUITE_P(Channels, Metric, testing::Values(1, 3));

TEST_P(Metric, LightMetricIsTheMeanOverLightsAndRotations) {
    // Compares with brute force: 360 rotations of two lights, weighted by their energy, and a hundredth of
    // natural light.
    const int channels = GetParam(), order = 4;
    std::mt19937 random(7);
    const std::vector<Light> lights = {random_light(order, random), random_light(order + 1, random)};
    const Transfer a = random_transfer(20, order, channels, 1), b = random_transfer(20, order, channels, 2);
    const std::vector<float> areas(20, 1.0f);
    LitSums sums;
    for (const Light& given : lights) {
        const Light light = truncated(given, order);
        double energy = 0;
        for (const glm::vec3& c : light.coefficients)
            energy += static_cast<double>(glm::dot(c, c));
        for (int rotation = 0; rotation < 360; ++rotation) {
            const Light rotated = rotated_about_y(light, rotation * M_PI / 180);
            sums.add(exit_radiance(a, rotated), exit_radiance(b, rotated), 1 / energy);
        }
    }
    const double found =
        expected_lit_rms(a, b, areas, metric_of_lights(lights, layout_of_one(order, channels)));
    EXPECT_NEAR(found, sums.rms(), 0.01 * found); // the hundredth
}

TEST_P(Metric, NaturalLightIsTheMeanOverRandomLight) {
    const int channels = GetParam(), order = 3;
    std::mt19937 random(9);
    const Transfer a = random_transfer(30, order, channels, 3), b = random_transfer(30, order, channels, 4);
    const std::vector<float> areas(30, 1.0f);
    LitSums sums;
    for (int i = 0; i < 4000; ++i) {
        Light light = random_light(order, random);
        for (int k = 1; k < order * order; ++k)
            light.coefficients[static_cast<std::size_t>(k)] *=
                std::sqrt(0.28f * std::pow(std::floor(std::sqrt(static_cast<float>(k))), -0.6f));
        sums.add(exit_radiance(a, light), exit_radiance(b, light));
    }
    const double found = expected_lit_rms(a, b, areas, natural_metric(layout_of_one(order, channels)));
    EXPECT_NEAR(found, sums.rms(), 0.02 * found); // 4000 lights: 1 to 2 %
}

/// Skies of steeper bands, and suns anywhere of one power in every band, which direct light is lit by half of
/// the time.
TEST(MetricOfTerms, TwoTermsUseTheMeanOverRandomSkiesWithSuns) {
    const TransferLayout layout{3, {{TermKind::direct, 1}, {TermKind::indirect, 3}}};
    std::mt19937 random(11);
    const Transfer a = random_transfer(30, layout, 11), b = random_transfer(30, layout, 111);
    LitSums sums;
    for (int i = 0; i < 4000; ++i) {
        Lighting lighting{random_light(3, random), random_light(3, random)};
        for (std::size_t k = 0; k < 9; ++k) {
            if (k > 0)
                lighting.sky.coefficients[k] *=
                    std::sqrt(0.24f * std::pow(std::floor(std::sqrt(static_cast<float>(k))), -0.85f));
            lighting.suns->coefficients[k] *= std::sqrt(0.1f);
        }
        if (i % 2 == 0)
            lighting = {sum(lighting.sky, *lighting.suns)};
        sums.add(exit_radiance(a, lighting), exit_radiance(b, lighting));
    }
    const double found = expected_lit_rms(a, b, std::vector<float>(30, 1.0f), natural_metric(layout));
    EXPECT_NEAR(found, sums.rms(), 0.02 * found); // 4000 lights: 1 to 2 %
}

TEST(MetricOfTerms, LightsWithSunsUseTheMeanOverRotations) {
    const TransferLayout layout{4, {{TermKind::direct, 1}, {TermKind::indirect, 3}}};
    std::mt19937 random(12);
    const Lighting lighting{random_light(4, random), random_light(5, random)};
    const Transfer a = random_transfer(20, layout, 12), b = random_transfer(20, layout, 112);
    LitSums sums;
    for (int rotation = 0; rotation < 360; ++rotation) {
        const Lighting rotated{rotated_about_y(lighting.sky, rotation * M_PI / 180),
                               rotated_about_y(truncated(*lighting.suns, 4), rotation * M_PI / 180)};
        sums.add(exit_radiance(a, rotated), exit_radiance(b, rotated));
    }
    const double found =
        expected_lit_rms(a, b, std::vector<float>(20, 1.0f), metric_of_lights(std::vector{lighting}, layout));
    EXPECT_NEAR(found, sums.rms(), 0.01 * found); // the hundredth of natural light
}

/// Each lamp shines separately, in addition to any sky.
TEST(MetricOfTerms, LampsUseTheMeanOverStrengths) {
    const TransferLayout layout{
        2, {{TermKind::combined, 1}, {TermKind::lamp, 1, "white"}, {TermKind::lamp, 3, "red"}}};
    std::mt19937 random(14);
    const Transfer a = random_transfer(30, layout, 14), b = random_transfer(30, layout, 114);
    std::normal_distribution<float> normal;
    LitSums sums;
    for (int i = 0; i < 4000; ++i) {
        Lighting lighting{random_light(2, random)};
        for (std::size_t k = 1; k < 4; ++k)
            lighting.sky.coefficients[k] *= std::sqrt(0.28f);
        for (int k = 0; k < 2; ++k)
            lighting.lamps.emplace_back(normal(random), normal(random), normal(random));
        sums.add(exit_radiance(a, lighting), exit_radiance(b, lighting));
    }
    const double found = expected_lit_rms(a, b, std::vector<float>(30, 1.0f), natural_metric(layout));
    EXPECT_NEAR(found, sums.rms(), 0.02 * found); // 4000 lights: 1 to 2 %
}

/// However bright lamps are: to lose them all is half of all there is, to lose the sky is, too, and each lamp
/// counts as much as the other, unless it is dark.
TEST(MetricOfTerms, BalancedGivesAllLampsTheWeightOfTheSky) {
    const TransferLayout layout{
        3,
        {{TermKind::direct, 1}, {TermKind::indirect, 3}, {TermKind::lamp, 1, "a"}, {TermKind::lamp, 3, "b"}}};
    const std::size_t of_sky = 36, of_a = 1;
    const std::vector<float> areas = {1, 2, 0, 4, 5};
    for (const float bright : {1e-3f, 1.0f, 1e3f}) {
        Transfer transfer = random_transfer(5, layout, 15);
        for (std::size_t p = 0; p < 5; ++p)
            for (float& v : transfer.vector(p).subspan(of_sky))
                v *= bright;
        for (std::size_t p = 0; p < 5; ++p)
            transfer.vector(p)[of_sky] *= 100; // one lamp is brighter than the other
        Transfer without_lamps = transfer, without_sky = transfer, without_a = transfer;
        for (std::size_t p = 0; p < 5; ++p) {
            std::ranges::fill(without_lamps.vector(p).subspan(of_sky), 0.0f);
            std::ranges::fill(without_sky.vector(p).first(of_sky), 0.0f);
            std::ranges::fill(without_a.vector(p).subspan(of_sky, of_a), 0.0f);
        }
        const LightMetric metric = balanced(natural_metric(layout), transfer, areas);
        EXPECT_NEAR(expected_lit_rms(transfer, without_lamps, areas, metric), std::sqrt(0.5), 1e-6);
        EXPECT_NEAR(expected_lit_rms(transfer, without_sky, areas, metric), std::sqrt(0.5), 1e-6);
        EXPECT_NEAR(expected_lit_rms(transfer, without_a, areas, metric), std::sqrt(0.25), 1e-6);
    }
}

TEST(MetricOfTerms, PlainCountsAGreyTermForEachColor) {
    const TransferLayout layout{2, {{TermKind::direct, 1}, {TermKind::indirect, 3}}};
    Transfer a = zero_transfer(layout, 5), b = a;
    for (std::size_t i = 0; i < a.vectors.size(); ++i) {
        a.vectors[i] = static_cast<float>(i % 7);
        b.vectors[i] = static_cast<float>(i % 5);
    }
    const std::vector<float> areas = {1, 2, 3, 4, 5};
    EXPECT_NEAR(expected_lit_rms(a, b, areas, plain_metric(layout)), relative_l2(a, b, areas), 1e-9);
}

TEST_P(Metric, PlainIsRelativeL2) {
    const Transfer a = random_transfer(30, 5, GetParam(), 5), b = random_transfer(30, 5, GetParam(), 6);
    std::vector<float> areas;
    for (int p = 0; p < 30; ++p)
        areas.push_back(static_cast<float>(p));
    EXPECT_NEAR(expected_lit_rms(a, b, areas, plain_metric(layout_of_one(5, GetParam()))),
                relative_l2(a, b, areas), 1e-9);
}

TEST(LightMetric, RejectsInvalidInput) {
    std::mt19937 random(1);
    const std::vector<Light> low = {random_light(3, random)};
    EXPECT_THROW(metric_of_lights(low, layout_of_one(4, 1)), Error);
    EXPECT_THROW(metric_of_lights(std::vector<Light>{constant_light(4, glm::vec3(0))}, layout_of_one(4, 1)),
                 Error);
    EXPECT_THROW(metric_of_lights(std::vector<Light>{}, layout_of_one(4, 1)), Error);
    const Transfer a = random_transfer(3, 4, 1, 1);
    EXPECT_THROW(expected_lit_rms(a, a, std::vector<float>(3, 1.0f), natural_metric(layout_of_one(5, 1))),
                 Error);
}

TEST(ExpectedLitRms, CountsEveryReceiver) {
    Transfer reference = zero_transfer(1, 1, 9000); // more than one thread processes at a time
    std::fill(reference.vectors.begin(), reference.vectors.end(), 1.0f);
    Transfer other = reference;
    for (std::size_t p = 8550; p < 9000; ++p)
        other.vectors[p] = 0.5f;
    const std::vector<float> areas(reference.receivers(), 2.0f);
    EXPECT_NEAR(expected_lit_rms(reference, other, areas, plain_metric(layout_of_one(1, 1))),
                std::sqrt(0.05 * 0.25), 1e-9);
}

} // namespace
} // namespace prt
