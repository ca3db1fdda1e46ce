// Tests the basis of spherical harmonics.

#include "prt/core/sh.h"

#include "prt/core/error.h"
#include "prt/core/sh_rotation.h"
#include "support/quadrature.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace prt {
namespace {

using std::numbers::pi;
using Basis = std::array<double, kMaxOrder * kMaxOrder>;

glm::dvec3 random_direction(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

glm::dmat3 random_rotation(std::mt19937& random) {
    std::normal_distribution<double> n;
    return glm::dmat3(glm::mat4_cast(glm::normalize(glm::dquat(n(random), n(random), n(random), n(random)))));
}

TEST(Sh, HasTheSignsAndConstantsOfTheConvention) {
    Basis y{};
    const glm::dvec3 d = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
    evaluate_sh(3, d, y);
    EXPECT_NEAR(y[0], 0.282095, 1e-6);
    EXPECT_NEAR(y[1], -0.488603 * d.y, 1e-6);
    EXPECT_NEAR(y[2], 0.488603 * d.z, 1e-6);
    EXPECT_NEAR(y[3], -0.488603 * d.x, 1e-6);
    EXPECT_NEAR(y[4], 1.092548 * d.x * d.y, 1e-6);
    EXPECT_NEAR(y[5], -1.092548 * d.y * d.z, 1e-6);
    EXPECT_NEAR(y[6], 0.315392 * (3 * d.z * d.z - 1), 1e-6);
    EXPECT_NEAR(y[7], -1.092548 * d.x * d.z, 1e-6);
    EXPECT_NEAR(y[8], 0.546274 * (d.x * d.x - d.y * d.y), 1e-6);
}

class ShOrder : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(All, ShOrder, testing::Range(1, kMaxOrder + 1));

TEST_P(ShOrder, BasisIsOrthonormal) {
    const int order = GetParam();
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    std::vector<double> gram(count * count, 0);
    Basis y{};
    for (const auto& [direction, weight] : test::sphere_quadrature(order + 1)) {
        evaluate_sh(order, direction, y);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < count; ++j)
                gram[i * count + j] += weight * y[i] * y[j];
    }
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < count; ++j)
            EXPECT_NEAR(gram[i * count + j], i == j ? 1 : 0, 1e-12) << i << ", " << j;
}

TEST_P(ShOrder, FloatAgreesWithDouble) {
    const int order = GetParam();
    std::mt19937 random(1);
    Basis exact{};
    std::array<float, kMaxOrder * kMaxOrder> y{};
    for (int trial = 0; trial < 200; ++trial) {
        const glm::vec3 d(random_direction(random));
        evaluate_sh(order, glm::dvec3(d), exact);
        evaluate_sh(order, d, y);
        for (std::size_t i = 0; i < static_cast<std::size_t>(coefficient_count(order)); ++i)
            EXPECT_NEAR(static_cast<double>(y[i]), exact[i], 5e-6); // some 20 roundings of values up to 3
    }
}

TEST_P(ShOrder, LowerOrdersAreTheBeginningOfHigherOnes) {
    Basis low{}, high{};
    const glm::dvec3 d = glm::normalize(glm::dvec3(-0.2, 0.9, 0.4));
    evaluate_sh(GetParam(), d, low);
    evaluate_sh(kMaxOrder, d, high);
    for (std::size_t i = 0; i < static_cast<std::size_t>(coefficient_count(GetParam())); ++i)
        EXPECT_NEAR(low[i], high[i], 1e-14);
}

TEST_P(ShOrder, ClampedCosineLobeIsTheIntegralOfTheClampedCosine) {
    const int order = GetParam();
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.5, 0.2, -0.7));
    Basis lobe{};
    clamped_cosine_lobe(order, normal, lobe);
    Basis integrals{}, y{};
    for (const auto& [w, weight] : test::sphere_cells(200)) {
        const double value = std::max(0.0, glm::dot(normal, w)) / pi * weight;
        if (value == 0)
            continue;
        evaluate_sh(order, w, y);
        for (std::size_t i = 0; i < static_cast<std::size_t>(coefficient_count(order)); ++i)
            integrals[i] += value * y[i];
    }
    // Higher bands use the same code; each parity is tested.
    for (std::size_t i = 0; i < std::min<std::size_t>(static_cast<std::size_t>(coefficient_count(order)), 41);
         ++i)
        EXPECT_NEAR(lobe[i], integrals[i], 2e-4) << i; // the midpoint rule errs by the square of a cell, 0.01
}

TEST_P(ShOrder, RotatingCoefficientsRotatesTheFunction) {
    const int order = GetParam();
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 5; ++trial) {
        const glm::dmat3 r = random_rotation(random);
        const auto count = static_cast<std::size_t>(coefficient_count(order));
        std::vector<double> c(count), rotated(count);
        for (double& v : c)
            v = normal(random);
        ShRotation(order, r).apply(std::span<const double>(c), std::span<double>(rotated));
        for (int k = 0; k < 20; ++k) {
            const glm::dvec3 w = random_direction(random);
            Basis at_w{}, at_origin{};
            evaluate_sh(order, w, at_w);
            evaluate_sh(order, glm::transpose(r) * w, at_origin);
            double f_rotated = 0, f = 0;
            for (std::size_t i = 0; i < count; ++i) {
                f_rotated += rotated[i] * at_w[i];
                f += c[i] * at_origin[i];
            }
            EXPECT_NEAR(f_rotated, f, 1e-11);
        }
    }
}

TEST(ShRotation, TenThousandSmallStepsKeepTheNorm) {
    constexpr int kOrder = 10;
    const glm::dmat3 step(glm::rotate(glm::dmat4(1), 0.1, glm::normalize(glm::dvec3(1, 2, 3))));
    const ShRotation rotation(kOrder, step);
    std::vector<glm::vec3> light(coefficient_count(kOrder));
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    double before = 0, after = 0;
    for (glm::vec3& v : light) {
        v = glm::vec3(normal(random), normal(random), normal(random));
        before += static_cast<double>(glm::dot(v, v));
    }
    for (int i = 0; i < 10000; ++i)
        rotation.apply(light);
    for (const glm::vec3& v : light)
        after += static_cast<double>(glm::dot(v, v));
    EXPECT_NEAR(std::sqrt(after / before), 1, 1e-5);
}

TEST(ShRotation, IdentityKeepsTheFunction) {
    std::vector<double> in(100), out(100);
    for (std::size_t i = 0; i < in.size(); ++i)
        in[i] = static_cast<double>(i) - 50;
    ShRotation(10, glm::dmat3(1)).apply(std::span<const double>(in), std::span<double>(out));
    for (std::size_t i = 0; i < in.size(); ++i)
        EXPECT_NEAR(out[i], in[i], 1e-12);
}

TEST(Sh, WindowsAreASquaredCosineAndTheMeanOfACosine) {
    constexpr int kSteps = 1000;
    for (const double width : {1.0, 3.0, 6.5, 10.0})
        for (int l = 0; l < 12; ++l) {
            double mean = 0; // sin(t)/t is the integral of cos(t x) for x from 0 to 1
            for (int i = 0; i < kSteps; ++i)
                mean += std::cos(pi * l / width * (i + 0.5) / kSteps) / kSteps;
            const double half = std::cos(pi * l / (2 * width));
            EXPECT_NEAR(hann_window(l, width), l < width ? half * half : 0, 1e-12) << l << " " << width;
            EXPECT_NEAR(lanczos_window(l, width), l < width ? mean : 0, 1e-6) << l << " " << width;
        }
}

TEST(Sh, OrdersOutsideTheRangeAreRejected) {
    EXPECT_THROW(check_order(0), Error);
    EXPECT_THROW(check_order(11), Error);
    EXPECT_NO_THROW(check_order(1));
    EXPECT_NO_THROW(check_order(10));
}

} // namespace
} // namespace prt
