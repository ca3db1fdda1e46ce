// Tests arithmetic on vectors of spherical harmonics.

#include "prt/core/sh.h"

#include "prt/core/light.h"
#include "support/quadrature.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace prt {
namespace {

using std::numbers::pi;
using Basis = std::array<double, 100>;

std::vector<double> random_function(int order, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> f(static_cast<std::size_t>(coefficient_count(order)));
    for (double& v : f)
        v = normal(random);
    return f;
}

class ShVectorOrder : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(All, ShVectorOrder, testing::Range(1, kMaxOrder + 1));

TEST_P(ShVectorOrder, ProductIsTheProjectionOfThePointwiseProduct) {
    const int order = GetParam();
    const auto a = random_function(order, 1), b = random_function(order, 2);
    std::vector<double> expected(a.size(), 0), measured(a.size());
    for (const auto& [w, weight] : test::sphere_quadrature(24)) { // exact to degree 47
        Basis y{};
        evaluate_sh(order, w, std::span<double>(y));
        const double value = sh_value(order, std::span<const double>(a), w) *
                             sh_value(order, std::span<const double>(b), w) * weight;
        for (std::size_t i = 0; i < a.size(); ++i)
            expected[i] += value * y[i];
    }
    sh_product(order, a, b, measured);
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_NEAR(measured[i], expected[i], 1e-11) << i;

    const std::vector<float> af(a.begin(), a.end()), bf(b.begin(), b.end());
    std::vector<float> in_float(a.size());
    sh_product(order, af, bf, in_float);
    double scale = 0;
    for (const double v : expected)
        scale = std::max(scale, std::abs(v));
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_NEAR(static_cast<double>(in_float[i]), expected[i], 3e-6 * scale) << i;
}

TEST_P(ShVectorOrder, ProductWithOneIsTheFunctionItself) {
    const int order = GetParam();
    const auto a = random_function(order, 3);
    std::vector<double> one(a.size(), 0), product(a.size());
    one[0] = 2 * std::sqrt(pi); // 1 everywhere
    sh_product(order, a, one, product);
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_NEAR(product[i], a[i], 1e-12);
}

TEST_P(ShVectorOrder, ProductMatrixMultipliesAndIsSymmetric) {
    const int order = GetParam();
    const auto f = random_function(order, 4), g = random_function(order, 5);
    const std::size_t n = f.size();
    std::vector<double> matrix(n * n), product(n);
    sh_product_matrix(order, f, matrix);
    sh_product(order, f, g, product);
    for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) {
            sum += matrix[i * n + j] * g[j];
            EXPECT_NEAR(matrix[i * n + j], matrix[j * n + i], 1e-12);
        }
        EXPECT_NEAR(sum, product[i], 1e-11);
    }
}

TEST_P(ShVectorOrder, BatchesAreTheSingleDirections) {
    const int order = GetParam();
    std::mt19937 random(6);
    std::normal_distribution<float> normal;
    for (const std::size_t count : {0u, 1u, 15u, 16u, 17u, 100u}) {
        std::vector<glm::vec3> directions(count);
        for (glm::vec3& d : directions)
            d = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
        const auto n = static_cast<std::size_t>(coefficient_count(order));
        std::vector<float> batch(n * count, -9), single(n);
        evaluate_sh(order, directions, batch);
        for (std::size_t p = 0; p < count; ++p) {
            evaluate_sh(order, directions[p], std::span<float>(single));
            for (std::size_t i = 0; i < n; ++i)
                EXPECT_NEAR(batch[i * count + p], single[i], 2e-6f);
        }
    }
}

TEST(ShVector, FloatBasisIsOrthonormal) {
    constexpr std::size_t kCount = 100;
    std::vector<double> gram(kCount * kCount, 0);
    for (const auto& [w, weight] : test::sphere_quadrature(10)) {
        std::array<float, kCount> y{};
        evaluate_sh(10, glm::vec3(w), std::span<float>(y));
        for (std::size_t i = 0; i < kCount; ++i)
            for (std::size_t j = 0; j < kCount; ++j)
                gram[i * kCount + j] += weight * static_cast<double>(y[i]) * static_cast<double>(y[j]);
    }
    double worst = 0;
    for (std::size_t i = 0; i < kCount; ++i)
        for (std::size_t j = 0; j < kCount; ++j)
            worst = std::max(worst, std::abs(gram[i * kCount + j] - (i == j ? 1 : 0)));
    RecordProperty("largest_1e9", std::to_string(1e9 * worst));
    EXPECT_LT(worst, 1e-6);
}

TEST(ShVector, SumsAndScales) {
    const std::vector<float> a = {1, 2, 3, 4}, b = {0, 1, 0, -1};
    std::vector<float> out(4);
    sh_add<float>(a, b, out);
    EXPECT_EQ(out, (std::vector<float>{1, 3, 3, 3}));
    sh_scale<float>(out, 2, out);
    EXPECT_EQ(out, (std::vector<float>{2, 6, 6, 6}));
    EXPECT_EQ(sh_dot<float>(a, b), -2);
}

TEST(ShConventions, ThreeJsBasisHasEqualRadiance) {
    Light light{3, {}};
    for (int i = 0; i < 9; ++i)
        light.coefficients.emplace_back(1 + i, 2 - i, 0.5 * i);
    const auto c = to_three_js(light);
    const glm::vec3 n = glm::normalize(glm::vec3(0.3f, -0.5f, 0.7f));
    // The polynomials of three.js's SphericalHarmonics3.getBasisAt, by their published constants.
    const float x = n.x, y = n.y, z = n.z;
    const std::array<float, 9> basis = {0.282095f,
                                        0.488603f * y,
                                        0.488603f * z,
                                        0.488603f * x,
                                        1.092548f * x * y,
                                        1.092548f * y * z,
                                        0.315392f * (3 * z * z - 1),
                                        1.092548f * x * z,
                                        0.546274f * (x * x - y * y)};
    glm::vec3 value(0);
    for (std::size_t i = 0; i < 9; ++i)
        value += basis[i] * c[i];
    EXPECT_LT(glm::distance(value, radiance(light, n)), 1e-5f);
    const Light back = from_three_js(c);
    for (std::size_t i = 0; i < 9; ++i)
        EXPECT_EQ(back.coefficients[i], light.coefficients[i]);
}

TEST(ShConventions, GltfCoefficientsAreIrradiance) {
    const Light white = constant_light(3, {1, 1, 1});
    const auto e = to_gltf_irradiance(white);
    EXPECT_NEAR(e[0].r * 0.282095f, pi, 1e-5); // irradiance of uniform radiance 1
    const Light sun = directional_light(3, {0, 1, 0}, {1, 2, 3}),
                back = from_gltf_irradiance(to_gltf_irradiance(sun));
    for (std::size_t i = 0; i < 9; ++i)
        EXPECT_LT(glm::distance(back.coefficients[i], sun.coefficients[i]), 1e-6f);
    EXPECT_THROW(to_gltf_irradiance(constant_light(2, {1, 1, 1})), std::exception);
}

} // namespace
} // namespace prt
