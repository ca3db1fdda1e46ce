// Tests rotations of spherical harmonics.

#include "prt/core/sh_rotation.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace prt {
namespace {

using std::numbers::pi;
constexpr int kOrder = 10;

std::vector<double> random_function(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> f(100);
    for (double& v : f)
        v = normal(random);
    return f;
}

std::vector<double> rotated(const std::vector<double>& f, const ShRotation& rotation) {
    std::vector<double> out(f.size());
    rotation.apply(std::span<const double>(f), std::span<double>(out));
    return out;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

glm::dquat quaternion(double angle, const glm::dvec3& axis) {
    return glm::angleAxis(angle, glm::normalize(axis));
}

TEST(ShRotation, TwoRotationsCompose) {
    const auto f = random_function(1);
    const glm::dquat a = quaternion(0.7, {1, 2, 3}), b = quaternion(2.9, {-1, 0.2, 0.4});
    EXPECT_LT(largest_difference(rotated(rotated(f, ShRotation(kOrder, a)), ShRotation(kOrder, b)),
                                 rotated(f, ShRotation(kOrder, b * a))),
              1e-12);
    EXPECT_LT(largest_difference(
                  rotated(rotated(f, ShRotation(kOrder, a)), ShRotation(kOrder, glm::conjugate(a))), f),
              1e-12);
}

/// Compares with the function itself, for tilts whose axis is hardly visible in the matrix, and for half
/// rotations.
TEST(ShRotation, TinyTiltsAndHalfRotationsAreExact) {
    const auto f = random_function(2);
    for (const double tilt : {0.0, 1e-300, 1e-17, 1e-9, 1e-5, pi - 1e-9, pi}) {
        const glm::dmat3 r = glm::mat3_cast(quaternion(0.9, {0, 0, 1}) * quaternion(tilt, {1, 0.3, 0}));
        const auto g = rotated(f, ShRotation(kOrder, r));
        for (const glm::dvec3 d : {glm::dvec3(1, 2, 3), glm::dvec3(0.1, -2, 0.3), glm::dvec3(0, 0, 1)}) {
            const glm::dvec3 w = glm::normalize(d);
            std::vector<double> at(100), before(100);
            evaluate_sh(kOrder, w, std::span<double>(at));
            evaluate_sh(kOrder, glm::transpose(r) * w, std::span<double>(before));
            double value = 0, expected = 0;
            for (std::size_t i = 0; i < 100; ++i) {
                value += g[i] * at[i];
                expected += f[i] * before[i];
            }
            EXPECT_NEAR(value, expected, 1e-11) << tilt;
        }
    }
}

TEST(ShRotation, AxesMatchTheQuaternion) {
    const auto f = random_function(3);
    for (const double angle : {0.3, -2.0, 3.5}) {
        EXPECT_LT(largest_difference(rotated(f, ShRotation::about_x(kOrder, angle)),
                                     rotated(f, ShRotation(kOrder, quaternion(angle, {1, 0, 0})))),
                  1e-12);
        EXPECT_LT(largest_difference(rotated(f, ShRotation::about_y(kOrder, angle)),
                                     rotated(f, ShRotation(kOrder, quaternion(angle, {0, 1, 0})))),
                  1e-12);
        EXPECT_LT(largest_difference(rotated(f, ShRotation::about_z(kOrder, angle)),
                                     rotated(f, ShRotation(kOrder, quaternion(angle, {0, 0, 1})))),
                  1e-12);
    }
}

TEST(ShRotation, FloatsAndColorsAreTheSame) {
    const auto f = random_function(4);
    const ShRotation rotation(kOrder, quaternion(1.1, {3, -1, 2}));
    const auto expected = rotated(f, rotation);
    std::vector<float> in(f.begin(), f.end()), out(100);
    rotation.apply(std::span<const float>(in), std::span<float>(out));
    std::vector<glm::vec3> colors;
    for (const float v : in)
        colors.emplace_back(v, 2 * v, -v);
    rotation.apply(std::span<glm::vec3>(colors));
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_NEAR(static_cast<double>(out[i]), expected[i], 1e-6);
        EXPECT_NEAR(static_cast<double>(colors[i].r), expected[i], 1e-6);
        EXPECT_NEAR(static_cast<double>(colors[i].g), 2 * expected[i], 2e-6);
        EXPECT_NEAR(static_cast<double>(colors[i].b), -expected[i], 1e-6);
    }
}

/// Bands are independent, so a rotation of fewer bands equals the first bands of one of more, and changes no
/// further elements. Compared with the function itself.
TEST(ShRotation, RotatesTheFunctionInEveryOrder) {
    const glm::dmat3 r = glm::mat3_cast(quaternion(2.3, {0.3, -1, 0.7}));
    const glm::dvec3 w = glm::normalize(glm::dvec3(0.2, 0.9, -0.5)), before = glm::transpose(r) * w;
    const auto f = random_function(8);
    std::array<double, 100> at_w{}, at_before{};
    evaluate_sh(kOrder, w, std::span<double>(at_w));
    evaluate_sh(kOrder, before, std::span<double>(at_before));
    for (int order = 1; order <= kMaxOrder; ++order) {
        const auto count = static_cast<std::size_t>(order * order);
        std::vector<double> in(f.begin(), f.begin() + order * order), out(count);
        std::vector<float> floats(in.begin(), in.end()), beyond(count + 40, 7.0f);
        ShRotation(order, r).apply(std::span<const double>(in), std::span<double>(out));
        ShRotation(order, r).apply(std::span<const float>(floats), std::span<float>(beyond));
        double expected = 0, found = 0;
        for (std::size_t i = 0; i < count; ++i) {
            expected += in[i] * at_before[i];
            found += out[i] * at_w[i];
            EXPECT_NEAR(static_cast<double>(beyond[i]), out[i], 1e-6) << order << ", " << i;
        }
        EXPECT_NEAR(found, expected, 1e-12) << order;
        for (std::size_t i = count; i < beyond.size(); ++i)
            EXPECT_EQ(beyond[i], 7.0f) << order;
    }
}

TEST(ShRotation, FloatMatricesAreDecomposedAsRotations) {
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    const auto f = random_function(10);
    for (int i = 0; i < 50; ++i) {
        const glm::dmat3 r = glm::mat3_cast(
            glm::normalize(glm::dquat(normal(random), normal(random), normal(random), normal(random))));
        const auto exact = rotated(f, ShRotation(kOrder, r)),
                   rounded = rotated(f, ShRotation(kOrder, glm::dmat3(glm::mat3(r))));
        double before = 0, after = 0;
        for (std::size_t k = 0; k < f.size(); ++k) {
            before += f[k] * f[k];
            after += rounded[k] * rounded[k];
        }
        EXPECT_NEAR(after / before, 1, 1e-12);
        EXPECT_LT(largest_difference(exact, rounded), 1e-5);
    }
}

TEST(ShRotation, TenThousandComposedMatricesKeepTheNorm) {
    const glm::dmat3 step = glm::mat3_cast(quaternion(0.01, {1, -2, 0.5}));
    glm::mat3 all(1); // a game's own floats
    for (int i = 0; i < 10000; ++i)
        all = glm::mat3(step) * all;
    const auto f = random_function(5), g = rotated(f, ShRotation(kOrder, glm::dmat3(all)));
    double before = 0, after = 0;
    for (std::size_t i = 0; i < 100; ++i) {
        before += f[i] * f[i];
        after += g[i] * g[i];
    }
    EXPECT_NEAR(after / before, 1, 1e-12); // the input is orthonormalised
}

TEST(ShRotation, NonRotationsAreRejected) {
    const glm::dmat3 r = glm::mat3_cast(quaternion(0.4, {1, 1, 0}));
    EXPECT_THROW(ShRotation(3, 2.0 * r), Error);
    EXPECT_THROW(ShRotation(3, glm::dmat3(0)), Error);
    EXPECT_THROW(ShRotation(3, std::numeric_limits<double>::quiet_NaN() * r), Error);
    for (int i = 0; i < 9; ++i) { // one is as bad as nine
        glm::dmat3 one = r;
        one[i / 3][i % 3] = std::numeric_limits<double>::quiet_NaN();
        EXPECT_THROW(ShRotation(3, one), Error) << i;
    }
    EXPECT_NO_THROW(ShRotation(3, (1 + 0.4 * kRotationTolerance) * r));
    EXPECT_THROW(ShRotation(3, (1 + 0.6 * kRotationTolerance) * r), Error);
    EXPECT_THROW(ShRotation(3, glm::dquat(2, 0, 0, 0)), Error);
    EXPECT_THROW(ShRotation(0, r), Error);
    EXPECT_THROW(ShRotation(11, r), Error);
    glm::dmat3 mirrored = r;
    mirrored[0] *= -1.0;
    try {
        ShRotation(3, mirrored);
        ADD_FAILURE() << "a mirrored matrix was taken";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("mirror"), std::string::npos);
    }
}

} // namespace
} // namespace prt
