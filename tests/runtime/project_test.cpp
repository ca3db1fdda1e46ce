#include "prt/environment.h"

#include "prt/error.h"
#include "prt/sh.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace prt {
namespace {

using Radiance = std::function<glm::dvec3(const glm::dvec3&)>;

Environment lat_long(int width, int height, const Radiance& radiance) {
    Environment environment{{width, height, {}}, EnvironmentLayout::lat_long};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            environment.image.pixels.emplace_back(
                radiance(lat_long_direction(width, height, x + 0.5, y + 0.5)));
    return environment;
}

Environment cube(int size, const Radiance& radiance) {
    Environment environment{{size, 6 * size, {}}, EnvironmentLayout::cube};
    for (int y = 0; y < 6 * size; ++y)
        for (int x = 0; x < size; ++x)
            environment.image.pixels.emplace_back(radiance(
                cube_direction(y / size, 2.0 * x / (size - 1) - 1, 2.0 * (y % size) / (size - 1) - 1)));
    return environment;
}

double largest_difference(const Light& a, const Light& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.coefficients.size(); ++i)
        largest = std::max(largest, static_cast<double>(glm::distance(a.coefficients[i], b.coefficients[i])));
    return largest;
}

struct Size {
    int width, height;
};
class ConstantImage : public testing::TestWithParam<Size> {};
INSTANTIATE_TEST_SUITE_P(Sizes, ConstantImage,
                         testing::Values(Size{1, 1}, Size{2, 1}, Size{1, 7}, Size{13, 5}, Size{64, 32},
                                         Size{301, 97}));

TEST_P(ConstantImage, ProjectsToAConstantLightWhateverItsSize) {
    const auto [width, height] = GetParam();
    const Light light = project(lat_long(width, height, [](const auto&) { return glm::dvec3(1, 2, 3); }), 10);
    EXPECT_LT(largest_difference(light, constant_light(10, glm::vec3(1, 2, 3))), 3e-6); // floats of up to 10
}

TEST(ConstantCube, ProjectsToAConstantLightWhateverItsSize) {
    for (const int size : {1, 2, 3, 16, 65}) {
        Environment environment{{size, 6 * size, {}}, EnvironmentLayout::cube};
        environment.image.pixels.assign(static_cast<std::size_t>(6 * size * size), glm::vec3(1, 2, 3));
        // Three points per texel axis integrate cells of more than 0.2 rad to 1e-7 and better.
        EXPECT_LT(largest_difference(project(environment, 10), constant_light(10, glm::vec3(1, 2, 3))), 1e-5)
            << size;
    }
}

TEST(Project, BasisFunctionsComeBack) {
    // Radiance 1 + Y_i: the coefficients are those of a constant, plus one at i.
    for (const int i : {1, 2, 3, 4, 7, 8, 11, 20, 35}) {
        const auto function = [&](const glm::dvec3& w) {
            std::array<double, 100> y{};
            evaluate_sh(6, w, std::span<double>(y));
            return glm::dvec3(1 + y[static_cast<std::size_t>(i)]);
        };
        Light expected = constant_light(6, glm::vec3(1));
        expected.coefficients[static_cast<std::size_t>(i)] += 1.0f;
        EXPECT_LT(largest_difference(project(lat_long(512, 256, function), 6), expected), 1e-3) << i;
        EXPECT_LT(largest_difference(project(cube(129, function), 6), expected), 1e-3) << i;
    }
}

TEST(Project, ConeImageAgreesWithTheClosedForm) {
    // The image of the cone is antialiased over its texels, since nothing smaller than a texel can be said.
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.5, 0.4, 0.7));
    const double half_angle = 0.5;
    Environment environment{{1024, 512, {}}, EnvironmentLayout::lat_long};
    for (int y = 0; y < 512; ++y)
        for (int x = 0; x < 1024; ++x) {
            int inside = 0;
            for (int s = 0; s < 16; ++s)
                inside += glm::dot(axis, lat_long_direction(1024, 512, x + (s % 4 + 0.5) / 4,
                                                            y + (s / 4 + 0.5) / 4)) > std::cos(half_angle);
            environment.image.pixels.emplace_back(static_cast<float>(inside) / 16);
        }
    const Light light = project(environment, 10);
    const Light closed_form = cone_light(10, glm::vec3(axis), half_angle, glm::vec3(1));
    for (std::size_t i = 0; i < light.coefficients.size(); ++i)
        EXPECT_NEAR(light.coefficients[i].r, closed_form.coefficients[i].r, 1e-3f) << i;
}

TEST(Project, HardEdgedConeImageAgreesToo) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(-0.3, 0.8, 0.2));
    const Environment image = lat_long(1024, 512, [&](const glm::dvec3& w) {
        return glm::dvec3(glm::dot(axis, w) > std::cos(0.7) ? 1.0 : 0.0);
    });
    EXPECT_LT(largest_difference(project(image, 6), cone_light(6, glm::vec3(axis), 0.7, glm::vec3(1))) /
                  std::sqrt(3.0),
              1e-3);
}

TEST(Project, ATexelSizedSunAndADimSkyAreKeptApart) {
    Environment environment = lat_long(512, 256, [](const auto&) { return glm::dvec3(1e-3); });
    environment.image.at(100, 40) = glm::vec3(1e5f);
    const double theta0 = std::numbers::pi * 40 / 256, theta1 = std::numbers::pi * 41 / 256;
    const double solid_angle = 2 * std::numbers::pi / 512 * (std::cos(theta0) - std::cos(theta1));
    const double expected = 0.28209479 * (1e5 * solid_angle + 1e-3 * (4 * std::numbers::pi - solid_angle));
    EXPECT_NEAR(static_cast<double>(project(environment, 3).coefficients[0].r) / expected, 1, 1e-6);
}

TEST(Project, ASunAtThePoleComesFromAbove) {
    Environment environment = lat_long(64, 32, [](const auto&) { return glm::dvec3(0); });
    for (int x = 0; x < 64; ++x)
        environment.image.at(x, 0) = glm::vec3(1);
    const Light cap = cone_light(6, {0, 1, 0}, std::numbers::pi / 32, glm::vec3(1));
    EXPECT_LT(largest_difference(project(environment, 6), cap), 1e-7);
}

TEST(Project, DoesNotDependOnTheNumberOfThreads) {
    const Environment image =
        lat_long(200, 100, [](const glm::dvec3& w) { return glm::dvec3(1 + w.x, 2, 1 + w.y * w.z); });
    EXPECT_EQ(project(image, 6, 1).coefficients, project(image, 6, 2).coefficients);
    EXPECT_EQ(project(image, 6, 1).coefficients, project(image, 6, 7).coefficients);
}

TEST(Project, AnEmptyImageIsAnError) {
    EXPECT_THROW(project({}, 6), Error);
    EXPECT_THROW(project(lat_long(2, 1, [](const auto&) { return glm::dvec3(1); }), 11), Error);
}

} // namespace
} // namespace prt
