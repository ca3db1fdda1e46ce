// Tests the projection of environment maps to spherical harmonics.

#include "prt/core/environment.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "support/light_difference.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace prt {
namespace {

using test::largest_difference;

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

struct Size {
    int width, height;
};
class ConstantImage : public testing::TestWithParam<Size> {};
INSTANTIATE_TEST_SUITE_P(Sizes, ConstantImage,
                         testing::Values(Size{1, 1}, Size{2, 1}, Size{1, 7}, Size{13, 5}, Size{64, 32},
                                         Size{301, 97}));

TEST_P(ConstantImage, ProjectsToAConstantLightForAllSizes) {
    const auto [width, height] = GetParam();
    const Light light = project(lat_long(width, height, [](const auto&) { return glm::dvec3(1, 2, 3); }), 10);
    EXPECT_LT(largest_difference(light, constant_light(10, glm::vec3(1, 2, 3))), 3e-6); // floats of up to 10
}

TEST(ConstantCube, ProjectsToAConstantLightForAllSizes) {
    for (const int size : {1, 2, 3, 16, 65}) {
        Environment environment{{size, 6 * size, {}}, EnvironmentLayout::cube};
        environment.image.pixels.assign(static_cast<std::size_t>(6 * size * size), glm::vec3(1, 2, 3));
        // Three points per texel axis integrate cells of more than 0.2 rad to 1e-7 and better.
        EXPECT_LT(largest_difference(project(environment, 10), constant_light(10, glm::vec3(1, 2, 3))), 1e-5)
            << size;
    }
}

/// More rows than are summed at a time: a half sphere of radiance 1 has the mean 1/2 and the slope 3/4 in y.
TEST(Project, ImagesOfOneColumnAndMoreRowsThanABlock) {
    const Environment environment =
        lat_long(1, 10'000, [](const glm::dvec3& d) { return glm::dvec3(d.y > 0 ? 1 : 0); });
    const Light light = project(environment, 2);
    const double pi = std::numbers::pi;
    EXPECT_NEAR(light.coefficients[0].x, std::sqrt(pi), 1e-5);
    EXPECT_NEAR(light.coefficients[1].x, -std::sqrt(3 * pi) / 2, 1e-5);
}

/// More columns than are folded at a time, a quarter of them and all: a half sphere in x and one in z, so
/// that sines and cosines of all blocks count.
TEST(Project, ImagesOfOneRowAndMoreColumnsThanABlock) {
    for (const int width : {80'000, 20'002}) {
        const Environment environment = lat_long(
            width, 1, [](const glm::dvec3& d) { return glm::dvec3((d.x > 0 ? 1 : 0) + (d.z > 0 ? 1 : 0)); });
        const Light light = project(environment, 2);
        const double pi = std::numbers::pi, slope = std::sqrt(3 * pi) / 2;
        EXPECT_NEAR(light.coefficients[0].x, 2 * std::sqrt(pi), 2e-4); // edges of half a column
        EXPECT_NEAR(light.coefficients[2].x, slope, 2e-4);
        EXPECT_NEAR(light.coefficients[3].x, -slope, 2e-4);
    }
}

TEST(Project, BasisFunctionsRoundTrip) {
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
    // The image of the cone is antialiased over its texels, because an image does not resolve smaller
    // details.
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.5, 0.4, 0.7));
    const double half_angle = 0.5;
    Environment environment{{1024, 512, {}}, EnvironmentLayout::lat_long};
    for (int y = 0; y < 512; ++y)
        for (int x = 0; x < 1024; ++x) {
            int inside = 0;
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i < 4; ++i)
                    inside += glm::dot(axis, lat_long_direction(1024, 512, x + (i + 0.5) / 4,
                                                                y + (j + 0.5) / 4)) > std::cos(half_angle);
            environment.image.pixels.emplace_back(static_cast<float>(inside) / 16);
        }
    const Light light = project(environment, 10);
    const Light closed_form = cone_light(10, glm::vec3(axis), half_angle, glm::vec3(1));
    for (std::size_t i = 0; i < light.coefficients.size(); ++i)
        EXPECT_NEAR(light.coefficients[i].r, closed_form.coefficients[i].r, 1e-3f) << i;
}

TEST(Project, HardEdgedConeImageMatchesTheClosedForm) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(-0.3, 0.8, 0.2));
    const Environment image = lat_long(1024, 512, [&](const glm::dvec3& w) {
        return glm::dvec3(glm::dot(axis, w) > std::cos(0.7) ? 1.0 : 0.0);
    });
    EXPECT_LT(largest_difference(project(image, 6), cone_light(6, glm::vec3(axis), 0.7, glm::vec3(1))) /
                  std::sqrt(3.0),
              1e-3);
}

TEST(Project, SeparatesATexelSizedSunFromADimSky) {
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

TEST(Project, AnEnvironmentOfTheWrongShapeIsAnError) {
    const auto of = [](int width, int height, std::size_t pixels, EnvironmentLayout layout) {
        return Environment{{width, height, std::vector<glm::vec3>(pixels, glm::vec3(1))}, layout};
    };
    for (const Environment& environment :
         {of(4, 100, 400, EnvironmentLayout::cube_faces), of(10, 3, 30, EnvironmentLayout::cube),
          of(4, 2, 4, EnvironmentLayout::lat_long), of(4, 6, 24, EnvironmentLayout::angular)}) {
        EXPECT_THROW(project(environment, 3), Error);
        EXPECT_THROW(resampled_lat_long(environment), Error);
    }
    EXPECT_NO_THROW(project(of(4, 24, 96, EnvironmentLayout::cube), 3));
}

/// A hot texel in the middle of the image, seen by three ways of reading it.
TEST(Project, CenterOfALatLongImageFacesTheRequestedAxis) {
    for (const int width : {16, 18}) { // with and without a quarter in whole pixels
        Environment environment = lat_long(width, 9, [](const auto&) { return glm::dvec3(0); });
        environment.image.at(width / 2, 4) = environment.image.at(width / 2 - 1, 4) = glm::vec3(1);
        environment.image.at(width / 4, 4) = glm::vec3(0.2f, 0, 0); // left of the center
        const Light z = project(environment, 4);
        environment.center = LatLongCenter::x;
        const Light x = project(environment, 4);
        EXPECT_GT(radiance(z, {0, 0, 1}).g, 5 * std::abs(radiance(z, {1, 0, 0}).g));
        EXPECT_GT(radiance(x, {1, 0, 0}).g, 5 * std::abs(radiance(x, {0, 0, 1}).g));
        EXPECT_LT(largest_difference(x, rotated_about_y(z, std::numbers::pi / 2)), 1e-6);
        EXPECT_GT(sample(environment, {1, 0, 0}).g, 0.9f);
        EXPECT_GT(sample(environment, {0, 0, -1}).r, 0.01f);
        EXPECT_LT(
            largest_difference(project({resampled_lat_long(environment), EnvironmentLayout::lat_long}, 2),
                               truncated(x, 2)),
            width == 16 ? 1e-6 : 0.1);
    }
}

TEST(Project, AnEmptyImageIsAnError) {
    EXPECT_THROW(project({}, 6), Error);
    EXPECT_THROW(project(lat_long(2, 1, [](const auto&) { return glm::dvec3(1); }), 11), Error);
}

Environment angular(int size, const Radiance& radiance) {
    Environment environment{{size, size, {}}, EnvironmentLayout::angular};
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double u = 2 * (x + 0.5) / size - 1, v = 2 * (y + 0.5) / size - 1;
            // Texels with a center outside show the radiance of the nearest point inside.
            const double shrink = std::min(1.0, 1 / std::hypot(u, v));
            environment.image.pixels.emplace_back(radiance(angular_direction(shrink * u, shrink * v)));
        }
    return environment;
}

Environment cube_faces(int size, const Radiance& radiance) {
    Environment environment{{size, 6 * size, {}}, EnvironmentLayout::cube_faces};
    for (int y = 0; y < 6 * size; ++y)
        for (int x = 0; x < size; ++x)
            environment.image.pixels.emplace_back(radiance(
                cube_face_direction(y / size, (2.0 * x + 1) / size - 1, (2.0 * (y % size) + 1) / size - 1)));
    return environment;
}

TEST(OtherLayouts, ConstantImagesAreConstantLights) {
    for (const int size : {1, 2, 3, 16, 65}) {
        Environment faces{{size, 6 * size, {}}, EnvironmentLayout::cube_faces},
            probe{{size, size, {}}, EnvironmentLayout::angular};
        faces.image.pixels.assign(static_cast<std::size_t>(6 * size * size), glm::vec3(1, 2, 3));
        probe.image.pixels.assign(static_cast<std::size_t>(size * size), glm::vec3(1, 2, 3));
        const Light expected = constant_light(10, glm::vec3(1, 2, 3));
        EXPECT_LT(largest_difference(project(faces, 10), expected), 1e-5) << size;
        EXPECT_LT(largest_difference(project(probe, 10), expected), 2e-5) << size;
    }
    for (const int size : {158, 300, 421}) { // every way of integrating over texels
        Environment probe{{size, size, {}}, EnvironmentLayout::angular};
        probe.image.pixels.assign(static_cast<std::size_t>(size * size), glm::vec3(1, 2, 3));
        EXPECT_LT(largest_difference(project(probe, 10), constant_light(10, glm::vec3(1, 2, 3))), 2e-5)
            << size;
    }
}

TEST(OtherLayouts, BasisFunctionsRoundTrip) {
    for (const int i : {1, 2, 3, 4, 7, 11, 20, 35}) {
        const auto function = [&](const glm::dvec3& w) {
            std::array<double, 100> y{};
            evaluate_sh(6, w, std::span<double>(y));
            return glm::dvec3(1 + y[static_cast<std::size_t>(i)]);
        };
        Light expected = constant_light(6, glm::vec3(1));
        expected.coefficients[static_cast<std::size_t>(i)] += 1.0f;
        EXPECT_LT(largest_difference(project(cube_faces(128, function), 6), expected), 1e-3) << i;
        EXPECT_LT(largest_difference(project(angular(256, function), 6), expected), 2e-3) << i;
    }
}

/// Projects texel by texel, with 4 x 4 points in each, in double, without the symmetry and the floats of the
/// library.
Light by_texels(const Environment& environment, int order) {
    const Image& image = environment.image;
    const int size = image.width;
    const std::array<double, 4> nodes = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                         0.8611363115940526},
                                weights = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                           0.3478548451374538};
    std::vector<glm::dvec3> sum(static_cast<std::size_t>(coefficient_count(order)), glm::dvec3(0));
    std::vector<double> y(sum.size());
    for (int row = 0; row < image.height; ++row)
        for (int x = 0; x < size; ++x)
            for (std::size_t j = 0; j < 4; ++j)
                for (std::size_t i = 0; i < 4; ++i) {
                    const double u = (2 * x + 1 + nodes[i]) / size - 1,
                                 v = (2 * (row % size) + 1 + nodes[j]) / size - 1, r = std::hypot(u, v);
                    double share = weights[i] * weights[j] / (size * static_cast<double>(size));
                    glm::dvec3 w;
                    if (environment.layout == EnvironmentLayout::angular) {
                        if (r >= 1)
                            continue;
                        w = angular_direction(u, v);
                        share *= std::numbers::pi * std::sin(std::numbers::pi * r) / r;
                    } else {
                        w = cube_face_direction(row / size, u, v);
                        share /= std::pow(1 + u * u + v * v, 1.5);
                    }
                    evaluate_sh(order, w, std::span<double>(y));
                    for (std::size_t k = 0; k < sum.size(); ++k)
                        sum[k] += share * y[k] * glm::dvec3(image.at(x, row));
                }
    Light light{order, {}};
    for (const glm::dvec3& c : sum)
        light.coefficients.emplace_back(c);
    return light;
}

TEST(OtherLayouts, NoiseIsProjectedLikeSingleTexels) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> value(0, 2);
    for (const int size : {51, 64, 160})
        for (const EnvironmentLayout layout : {EnvironmentLayout::cube_faces, EnvironmentLayout::angular}) {
            if (size == 160 && layout != EnvironmentLayout::angular)
                continue; // its texels are small for an angular map alone
            const int height = layout == EnvironmentLayout::angular ? size : 6 * size;
            Environment environment{{size, height, {}}, layout};
            for (int i = 0; i < size * height; ++i)
                environment.image.pixels.emplace_back(value(random), value(random), value(random));
            // On the rim of an angular map the two cut texels differently.
            EXPECT_LT(largest_difference(project(environment, 10), by_texels(environment, 10)),
                      layout == EnvironmentLayout::angular ? 2e-4 : 5e-6)
                << size;
        }
}

TEST(OtherLayouts, SamplingFindsTheTexel) {
    const auto function = [](const glm::dvec3& w) { return 1.0 + glm::dvec3(w); };
    const Environment faces = cube_faces(64, function), probe = angular(128, function);
    for (const glm::vec3 d : {glm::vec3(1, 2, 3), glm::vec3(-3, 0.1f, 0.2f), glm::vec3(0.1f, -1, 0.3f),
                              glm::vec3(0.2f, 0.1f, -4), glm::vec3(0.3f, 5, 0.1f), glm::vec3(-1, -2, 2.5f)}) {
        const glm::vec3 w = glm::normalize(d);
        EXPECT_LT(glm::distance(sample(faces, w), 1.0f + w), 0.01f);
        EXPECT_LT(glm::distance(sample(probe, w), 1.0f + w), 0.03f);
        const Image flat = resampled_lat_long(probe);
        EXPECT_LT(glm::distance(sample_lat_long(flat, w), 1.0f + w), 0.08f);
    }
}

/// A sun in one texel of a lat-long map is a directional light at any position: at the poles, on the seam.
TEST(Project, ADeltaSunIsADirectionalLightEverywhere) {
    constexpr int kWidth = 2048, kHeight = 1024;
    for (const auto& [x, y] : {std::pair(5, 0), std::pair(700, kHeight - 1), std::pair(0, 300),
                               std::pair(kWidth - 1, 511), std::pair(1024, 512)}) {
        Environment environment{{kWidth, kHeight, {}}, EnvironmentLayout::lat_long};
        environment.image.pixels.assign(std::size_t{kWidth} * kHeight, glm::vec3(1e-3f));
        environment.image.at(x, y) = glm::vec3(1e5f, 2e5f, 0.5e5f);
        const double theta = std::numbers::pi / kHeight;
        const double solid_angle =
            2 * std::numbers::pi / kWidth * (std::cos(y * theta) - std::cos((y + 1) * theta));
        const glm::vec3 towards(lat_long_direction(kWidth, kHeight, x + 0.5, y + 0.5));
        const Light sun = directional_light(8, towards, glm::vec3(1e5f, 2e5f, 0.5e5f) * float(solid_angle));
        const Light expected = sum(sun, constant_light(8, glm::vec3(1e-3f)));
        const double scale = static_cast<double>(glm::length(expected.coefficients[0]));
        // At a pole a texel is a sector; its centroid is a sixth of a row from its center: 5e-4 radians, and
        // a function of band 7 changes by at most 7 times this.
        const double tolerance = y == 0 || y == kHeight - 1 ? 4e-3 : 1e-4;
        EXPECT_LT(largest_difference(project(environment, 8), expected), tolerance * scale) << x << " " << y;
    }
}

} // namespace
} // namespace prt
