// Tests errors over all rotations of a light.

#include "compress/metric/error_moments.h"

#include "prt/core/error.h"
#include "prt/core/error_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace prt {
namespace {

constexpr std::size_t kOfMoments = 4300; // more than one block of each stretch

TransferLayout with_lamps() {
    return {3, {{TermKind::combined, 1}, {TermKind::lamp, 1, "white"}, {TermKind::lamp, 3, "red"}}};
}

const TransferLayout kLayouts[] = {
    layout_of_one(5, 1),
    layout_of_one(3, 3),
    {4, {{TermKind::direct, 1}, {TermKind::indirect, 3}}},
    {2, {{TermKind::direct, 3}, {TermKind::indirect, 1}}},
    with_lamps(),
};

struct Case {
    Transfer reference, approximation;
    std::vector<float> areas;
    std::mt19937 random;
    std::normal_distribution<float> normal;

    explicit Case(const TransferLayout& layout)
        : reference(zero_transfer(layout, kOfMoments)), approximation(reference), random(3) {
        for (float& v : reference.vectors)
            v = normal(random);
        for (std::size_t i = 0; i < reference.vectors.size(); ++i)
            approximation.vectors[i] = reference.vectors[i] + 0.1f * normal(random);
        for (std::size_t p = 0; p < kOfMoments; ++p)
            areas.push_back(static_cast<float>(p % 5));
    }
    Light light(int order) {
        Light result{order, {}};
        for (int i = 0; i < order * order; ++i)
            result.coefficients.emplace_back(normal(random), normal(random), normal(random));
        return result;
    }
    Lighting lighting() {
        const TransferLayout& layout = reference.layout;
        Lighting result{light(layout.order)};
        if (layout.has(TermKind::direct))
            result.suns = light(layout.order + 1);
        for (std::size_t k = 0; k < layout.lamps(); ++k)
            result.lamps.emplace_back(normal(random), normal(random), normal(random));
        return result;
    }
    double measured(const Lighting& lighting) const {
        return lit_rms(exit_radiance(reference, lighting), exit_radiance(approximation, lighting), areas);
    }
    ErrorMoments moments(int threads = 0) const {
        return error_moments(reference, approximation, areas, threads);
    }
};

class MomentsOfLayouts : public testing::TestWithParam<TransferLayout> {};
INSTANTIATE_TEST_SUITE_P(Layouts, MomentsOfLayouts, testing::ValuesIn(kLayouts));

TEST_P(MomentsOfLayouts, MomentsMatchExitRadiance) {
    Case c(GetParam());
    const ErrorMoments moments = c.moments();
    for (int i = 0; i < 5; ++i) {
        const Lighting lighting = c.lighting();
        EXPECT_NEAR(lit_rms(moments, lighting), c.measured(lighting), 1e-5 * c.measured(lighting));
    }
}

TEST_P(MomentsOfLayouts, MomentsMatchTheMetric) {
    const Case c(GetParam());
    for (const LightMetric& metric : {natural_metric(GetParam()), plain_metric(GetParam())}) {
        const double expected = expected_lit_rms(c.reference, c.approximation, c.areas, metric);
        EXPECT_NEAR(expected_lit_rms(c.moments(), metric), expected, 1e-9 * expected);
    }
}

TEST_P(MomentsOfLayouts, MomentsDoNotDependOnThreads) {
    const Case c(GetParam());
    const ErrorMoments one = c.moments(1), three = c.moments(3);
    EXPECT_EQ(one.errors, three.errors);
    EXPECT_EQ(one.references, three.references);
}

/// Lamps keep their direction while the sky rotates.
TEST_P(MomentsOfLayouts, FindTheWorstRotation) {
    Case c(GetParam());
    const Lighting lighting = c.lighting();
    const ErrorMoments moments = c.moments();
    const LitRmsOverRotations found = lit_rms_over_rotations(moments, lighting);
    const auto at = [&](double angle) {
        Lighting rotated{rotated_about_y(lighting.sky, angle), {}, lighting.lamps};
        if (lighting.suns)
            rotated.suns = rotated_about_y(*lighting.suns, angle);
        return rotated;
    };
    double worst = 0;
    for (int degree = 0; degree < 720; ++degree)
        worst = std::max(worst, lit_rms(moments, at(degree * M_PI / 360)));
    EXPECT_GT(found.worst, worst * (1 - 1e-6));
    EXPECT_LT(found.worst, worst * (1 + 1e-4)); // at most half a degree from the maximum
    EXPECT_NEAR(c.measured(at(found.worst_angle)), found.worst, 1e-5 * found.worst);
}

/// A receiver that sees only band 1 along X is dark if light comes along Z. In space, the mean square of a
/// coefficient of band 1 is a third of its power.
TEST(ErrorMomentsOverRotations, UseATenthOfTheMeanOverAllRotationsInTheDark) {
    const TransferLayout layout = layout_of_one(2, 1);
    Transfer reference = zero_transfer(layout, 1), approximation = reference;
    reference.vector(0)[3] = 2;
    approximation.vector(0)[3] = 2;
    approximation.vector(0)[0] = 0.001f;
    Light light{2, std::vector<glm::vec3>(4, glm::vec3(0))};
    light.coefficients[0] = glm::vec3(5);
    light.coefficients[3] = glm::vec3(1);
    const LitRmsOverRotations found =
        lit_rms_over_rotations(error_moments(reference, approximation, std::vector<float>(1, 1.0f)), {light});
    EXPECT_NEAR(found.worst, 0.005 / (0.1 * std::sqrt(4.0 / 3)), 1e-6);
    EXPECT_NEAR(found.mean, 0.005 / std::sqrt(4.0 / 2), 1e-6);
}

/// Light in bands that transfer does not have: errors are relative to float rounding only.
TEST(ErrorMomentsOverRotations, AreFiniteForDifferentBandsOfTransferAndLight) {
    const TransferLayout layout = layout_of_one(2, 1);
    Transfer reference = zero_transfer(layout, 1), approximation = reference;
    reference.vector(0)[3] = 1;
    approximation.vector(0)[0] = 1e-9f;
    approximation.vector(0)[3] = 1;
    const ErrorMoments moments = error_moments(reference, approximation, std::vector<float>(1, 1.0f));
    EXPECT_NEAR(lit_rms_over_rotations(moments, {constant_light(2, glm::vec3(1))}).worst, 0.01, 1e-5);
}

TEST(ErrorMomentsOverRotations, HaveTheMeanOfTheLightMetric) {
    Case c(kLayouts[2]);
    const Lighting lighting = c.lighting();
    const ErrorMoments moments = c.moments();
    double error = 0, square = 0;
    for (int rotation = 0; rotation < 360; ++rotation) {
        const Lighting rotated{rotated_about_y(lighting.sky, rotation * M_PI / 180),
                               rotated_about_y(*lighting.suns, rotation * M_PI / 180)};
        const auto wanted = exit_radiance(c.reference, rotated),
                   found = exit_radiance(c.approximation, rotated);
        const double of_rotation = lit_scale(wanted, c.areas).mean_square;
        error += std::pow(lit_rms(wanted, found, c.areas), 2) * of_rotation;
        square += of_rotation;
    }
    const double mean = std::sqrt(error / square);
    EXPECT_NEAR(lit_rms_over_rotations(moments, lighting).mean, mean, 1e-5 * mean);
}

TEST(ErrorMoments, AreInfiniteForErrorsWithoutLightAndZeroInTheDark) {
    const TransferLayout layout = layout_of_one(2, 1);
    Transfer dark = zero_transfer(layout, 3), lit = dark;
    std::ranges::fill(lit.vectors, 1.0f);
    const std::vector<float> areas(3, 1.0f);
    const Light light = constant_light(2, glm::vec3(1));
    EXPECT_EQ(lit_rms(error_moments(dark, lit, areas), light), std::numeric_limits<double>::infinity());
    EXPECT_EQ(lit_rms(error_moments(dark, dark, areas), light), 0);
}

TEST(ErrorMoments, RejectMismatchedTransfers) {
    const std::vector<float> areas(3, 1.0f);
    const Transfer a = zero_transfer(2, 1, 3);
    EXPECT_THROW(error_moments(a, zero_transfer(2, 3, 3), areas), Error);
    EXPECT_THROW(error_moments(a, zero_transfer(2, 1, 2), areas), Error);
    const ErrorMoments moments = error_moments(a, a, areas);
    EXPECT_THROW(lit_rms(moments, constant_light(1, glm::vec3(1))), Error);
    EXPECT_THROW(expected_lit_rms(moments, natural_metric(layout_of_one(2, 3))), Error);
}

} // namespace
} // namespace prt
