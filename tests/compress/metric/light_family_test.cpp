// Tests the light families of the metric.

#include "compress/metric/light_family.h"

#include "compress/metric/standard_skies.h"
#include "prt/core/error_measures.h"
#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"

#include <Eigen/Cholesky>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <vector>

namespace prt {
namespace {

using std::numbers::pi;

TransferLayout of_two_terms(int order) {
    return {order, {{TermKind::direct, 1}, {TermKind::indirect, 3}}};
}

Eigen::MatrixXd matrix_of(const LightMetric& metric) {
    const auto n = static_cast<Eigen::Index>(metric.layout.dimension());
    return Eigen::Map<const Eigen::MatrixXd>(metric.moments.data(), n, n);
}

std::vector<double> random_vector(const TransferLayout& layout) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    std::vector<double> vector(layout.dimension());
    for (double& v : vector)
        v = normal(random);
    return vector;
}

/// Returns the cost of an error after rotating each run of its coefficients.
double cost(const LightMetric& metric, const std::vector<double>& error, const glm::dmat3& rotation) {
    const auto size = static_cast<std::size_t>(coefficient_count(metric.layout.order));
    const ShRotation rotated(metric.layout.order, rotation);
    Eigen::VectorXd d(static_cast<Eigen::Index>(error.size()));
    for (std::size_t begin = 0; begin < error.size(); begin += size)
        rotated.apply(std::span(error).subspan(begin, size), std::span(d.data() + begin, size));
    return d.dot(matrix_of(metric) * d);
}

glm::dmat3 about(const glm::dvec3& axis, double angle) {
    return glm::dmat3(glm::rotate(glm::dmat4(1), angle, glm::normalize(axis)));
}

class Family : public testing::TestWithParam<LightFamily> {};
class UprightFamily : public Family {};
INSTANTIATE_TEST_SUITE_P(All, Family,
                         testing::Values(LightFamily::natural, LightFamily::outdoor, LightFamily::indoor,
                                         LightFamily::day));
INSTANTIATE_TEST_SUITE_P(All, UprightFamily,
                         testing::Values(LightFamily::outdoor, LightFamily::indoor, LightFamily::day));

TEST_P(Family, DoesNotDependOnSceneRotation) {
    const TransferLayout layout = of_two_terms(5);
    const LightMetric metric = metric_of_family(GetParam(), layout);
    const std::vector<double> error = random_vector(layout);
    const double straight = cost(metric, error, glm::dmat3(1));
    for (const double angle : {0.1, 1.3, 4.0})
        EXPECT_NEAR(cost(metric, error, about({0, 1, 0}, angle)), straight, 1e-5 * straight); // float lights
}

TEST(NaturalFamily, DoesNotDependOnTheUpAxis) {
    const TransferLayout layout = of_two_terms(5);
    const LightMetric metric = metric_of_family(LightFamily::natural, layout);
    const std::vector<double> error = random_vector(layout);
    const double straight = cost(metric, error, glm::dmat3(1));
    EXPECT_NEAR(cost(metric, error, about({1, 0, 0}, 2)), straight, 1e-10 * straight);
    EXPECT_NEAR(cost(metric, error, about({1, 2, 3}, 1)), straight, 1e-10 * straight);
}

/// A receiver that looks up is lit by the sky, one that looks down by the ground or the floor.
TEST_P(UprightFamily, IsBrighterAbove) {
    const int order = 5;
    const LightMetric metric = metric_of_family(GetParam(), layout_of_one(order, 1));
    const auto size = static_cast<std::size_t>(coefficient_count(order));
    std::vector<double> up(size);
    clamped_cosine_lobe(order, {0, 1, 0}, up);
    EXPECT_GT(cost(metric, up, glm::dmat3(1)), 2 * cost(metric, up, about({1, 0, 0}, pi)));
}

TEST_P(Family, LeavesNoErrorFreeAtAnyOrder) {
    for (int order = 1; order <= kMaxOrder; ++order)
        for (const TransferLayout& layout : {layout_of_one(order, 1), of_two_terms(order)}) {
            const Eigen::MatrixXd moments = matrix_of(metric_of_family(GetParam(), layout));
            EXPECT_LT((moments - moments.transpose()).norm(), 1e-12 * moments.norm());
            EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(moments).info(), Eigen::Success) << order;
        }
}

/// Every draw is scaled to a mean square of 1 on open receivers; its mean over normals depends only on the
/// traces of bands. A hundredth of natural light is added.
TEST_P(UprightFamily, HasAMeanSquareOfOneOnOpenReceivers) {
    const int order = 6;
    const Eigen::MatrixXd moments = matrix_of(metric_of_family(GetParam(), layout_of_one(order, 1)));
    double sum = 0;
    for (int l = 0; l < order; ++l)
        sum += std::pow(clamped_cosine_factor(l), 2) * moments.diagonal().segment(l * l, 2 * l + 1).sum();
    EXPECT_NEAR(sum / (4 * pi), 1, 0.02);
}

/// With separate suns or without: open receivers have only direct light.
TEST_P(UprightFamily, HasAMeanSquareOfOneOnOpenReceiversInDirectLight) {
    const int order = 6;
    const Eigen::MatrixXd moments =
        matrix_of(metric_of_family(GetParam(), {order, {{TermKind::direct, 1}, {TermKind::indirect, 1}}}));
    double sum = 0;
    for (int l = 0; l < order; ++l)
        sum += std::pow(clamped_cosine_factor(l), 2) * moments.diagonal().segment(l * l, 2 * l + 1).sum();
    EXPECT_NEAR(sum / (4 * pi), 1, 0.05); // natural light's hundredth is of the suns of other parts, too
    EXPECT_GT(moments.bottomRightCorner(36, 36).trace(), 1.2 * moments.topLeftCorner(36, 36).trace());
}

/// Terms other than direct transfer additionally see only suns, and a sun has equal power in every band.
TEST(OutdoorFamily, DiffersBetweenTermsByItsSuns) {
    const int order = 5;
    const Eigen::Index size = coefficient_count(order);
    const Eigen::MatrixXd c = matrix_of(
        metric_of_family(LightFamily::outdoor, {order, {{TermKind::direct, 1}, {TermKind::indirect, 1}}}));
    const Eigen::VectorXd suns =
        (c.topLeftCorner(size, size) + c.bottomRightCorner(size, size) - 2 * c.topRightCorner(size, size))
            .diagonal();
    EXPECT_GT(suns[0], 0);
    for (int l = 1; l < order; ++l)
        EXPECT_NEAR(suns.segment(l * l, 2 * l + 1).mean(), suns[0], 1e-4 * suns[0]); // lights are floats
}

/// Lightings drawn from the model: a member, a rotation, a texture, suns separate or not.
class Draws {
public:
    Draws(LightFamily family, int order) : model_(family_model(family, order)), order_(order) {
        std::vector<double> weights;
        for (const FamilyMember& member : model_.members)
            weights.push_back(member.weight);
        choice_ = std::discrete_distribution<std::size_t>(weights.begin(), weights.end());
    }

    Lighting next() {
        const FamilyMember& member = model_.members[choice_(random_)];
        Lighting lighting = member.lighting;
        const float band_0 = lighting.sky.coefficients[0].x;
        std::vector<double> powers = model_.texture;
        for (double& power : powers)
            power *= static_cast<double>(band_0 * band_0);
        if (lighting.suns && uniform_(random_) < 0.5)
            lighting = {sum(lighting.sky, *lighting.suns)};
        const double square = open_square(lighting.sky, powers); // in direct light
        for (int l = 0; l < order_; ++l)
            for (int i = l * l; i < (l + 1) * (l + 1); ++i)
                lighting.sky.coefficients[static_cast<std::size_t>(i)] +=
                    static_cast<float>(std::sqrt(powers[static_cast<std::size_t>(l)]) * normal_(random_));
        const double angle = 2 * pi * uniform_(random_);
        lighting.sky = scaled(rotated_about_y(lighting.sky, angle), 1 / std::sqrt(square));
        if (lighting.suns)
            lighting.suns = scaled(rotated_about_y(*lighting.suns, angle), 1 / std::sqrt(square));
        return lighting;
    }

private:
    static Light scaled(Light light, double factor) {
        for (glm::vec3& c : light.coefficients)
            c *= static_cast<float>(factor);
        return light;
    }

    FamilyModel model_;
    int order_;
    std::mt19937 random_{21};
    std::discrete_distribution<std::size_t> choice_;
    std::normal_distribution<double> normal_;
    std::uniform_real_distribution<double> uniform_;
};

TEST_P(UprightFamily, ExpectsTheMeanErrorOfItsDraws) {
    const TransferLayout layout = of_two_terms(4);
    constexpr std::size_t kCount = 30;
    Transfer a = zero_transfer(layout, kCount), b = a;
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    for (float& v : a.vectors)
        v = normal(random);
    for (float& v : b.vectors)
        v = normal(random);
    const std::vector<float> areas(kCount, 1.0f);
    Draws draws(GetParam(), layout.order);
    double error = 0, square = 0;
    for (int i = 0; i < 6000; ++i) {
        const Lighting lighting = draws.next();
        const auto wanted = exit_radiance(a, lighting), found = exit_radiance(b, lighting);
        for (std::size_t p = 0; p < kCount; ++p) {
            error += static_cast<double>(glm::dot(wanted[p] - found[p], wanted[p] - found[p]));
            square += static_cast<double>(glm::dot(wanted[p], wanted[p]));
        }
    }
    const double measured = std::sqrt(error / square);
    EXPECT_NEAR(expected_lit_rms(a, b, areas, metric_of_family(GetParam(), layout)), measured,
                0.015 * measured); // 6000 draws: 0.5 %; and natural light's hundredth
}

TEST(StandardSkies, HaveAMeanRadianceOfOne) {
    for (const Lighting& lighting :
         {daylight(4, {.sun_elevation = 0.2, .turbidity = 6}), overcast_day(4), room_light(4, 1)})
        EXPECT_NEAR(radiance(truncated(lighting.sky, 1), {0, 1, 0}).x, 1, 1e-5f);
}

/// Sky, sun and ground are consistent: a receiver facing down sees a fifth of the light on the ground.
TEST(StandardSkies, LightTheReflectingGround) {
    const auto seen = [](const Light& light, const glm::dvec3& normal) {
        std::array<double, kMaxOrder * kMaxOrder> lobe{};
        clamped_cosine_lobe(kMaxOrder, normal, std::span<double>(lobe));
        double sum = 0;
        for (std::size_t i = 0; i < lobe.size(); ++i)
            sum += lobe[i] * static_cast<double>(light.coefficients[i].x);
        return sum;
    };
    for (const double elevation : {0.1, 0.7, 1.4}) {
        const Lighting day = daylight(kMaxOrder, {.sun_elevation = elevation, .turbidity = 3});
        const Light all = sum(day.sky, *day.suns);
        // Ten bands have an error of 1 % of the sun's light on ground facing away from it.
        EXPECT_NEAR(seen(day.sky, {0, -1, 0}) / seen(all, {0, 1, 0}), 0.2, 0.01) << elevation;
    }
    const Light overcast = overcast_day(kMaxOrder).sky;
    EXPECT_NEAR(seen(overcast, {0, -1, 0}) / seen(overcast, {0, 1, 0}), 0.2, 0.01);
}

} // namespace
} // namespace prt
