// Tests lookups and resampling of environment layouts.

#include "prt/core/environment.h"

#include "prt/core/error.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace prt {
namespace {

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_NEAR(glm::distance(a, b), 0, 1e-12);
}

TEST(LatLong, TopIsUpCenterIsZAndXIsAQuarterToTheLeft) {
    expect_near(lat_long_direction(8, 4, 4, 2), {0, 0, 1});
    expect_near(lat_long_direction(8, 4, 2, 2), {1, 0, 0});
    expect_near(lat_long_direction(8, 4, 6, 2), {-1, 0, 0});
    expect_near(lat_long_direction(8, 4, 0, 2), {0, 0, -1});
    expect_near(lat_long_direction(8, 4, 3, 0), {0, 1, 0});
    expect_near(lat_long_direction(8, 4, 3, 4), {0, -1, 0});
}

TEST(LatLong, PositionUndoesDirection) {
    for (double x = 0.3; x < 20; x += 1.7)
        for (double y = 0.2; y < 10; y += 0.9) {
            const glm::dvec2 p = lat_long_position(20, 10, lat_long_direction(20, 10, x, y));
            EXPECT_NEAR(p.x, x, 1e-9);
            EXPECT_NEAR(p.y, y, 1e-9);
        }
}

TEST(LatLong, SamplingAtATexelCenterReturnsTheTexel) {
    Environment environment{{8, 4, {}}, EnvironmentLayout::lat_long};
    for (int i = 0; i < 32; ++i)
        environment.image.pixels.emplace_back(i, 2 * i, 3 * i);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) {
            const glm::vec3 value =
                sample(environment, glm::vec3(lat_long_direction(8, 4, x + 0.5, y + 0.5)));
            EXPECT_NEAR(value.r, environment.image.at(x, y).r, 1e-3f);
        }
}

TEST(Cube, SamplingAtATexelReturnsTheTexel) {
    constexpr int kSize = 5;
    Environment environment{{kSize, 6 * kSize, {}}, EnvironmentLayout::cube};
    for (int i = 0; i < 6 * kSize * kSize; ++i)
        environment.image.pixels.emplace_back(static_cast<float>(i));
    for (int face = 0; face < 6; ++face)
        for (int y = 1; y < kSize - 1; ++y) // border texels belong to two faces
            for (int x = 1; x < kSize - 1; ++x) {
                const glm::dvec3 d =
                    cube_direction(face, 2.0 * x / (kSize - 1) - 1, 2.0 * y / (kSize - 1) - 1);
                EXPECT_NEAR(sample(environment, glm::vec3(d)).r, environment.image.at(x, face * kSize + y).r,
                            1e-3f);
            }
}

TEST(Cube, ResamplesToTheSamePicture) {
    constexpr int kSize = 33;
    Environment cube{{kSize, 6 * kSize, {}}, EnvironmentLayout::cube};
    for (int y = 0; y < 6 * kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const glm::dvec3 d =
                cube_direction(y / kSize, 2.0 * x / (kSize - 1) - 1, 2.0 * (y % kSize) / (kSize - 1) - 1);
            cube.image.pixels.emplace_back(glm::vec3(2 + d.x, 2 + d.y, 2 + d.z));
        }
    const Image flat = resampled_lat_long(cube);
    EXPECT_EQ(flat.width, 2 * flat.height);
    for (int y = 0; y < flat.height; y += 5)
        for (int x = 0; x < flat.width; x += 7) {
            const glm::dvec3 d = lat_long_direction(flat.width, flat.height, x + 0.5, y + 0.5);
            EXPECT_NEAR(glm::distance(flat.at(x, y), glm::vec3(d) + 2.0f), 0, 2e-3f);
        }
}

TEST(LatLong, ImagesOfOtherLayoutsHaveEqualAngularResolution) {
    const auto size = [](EnvironmentLayout layout, int width, int height) {
        const auto pixels = static_cast<std::size_t>(width * height);
        const Image flat = resampled_lat_long(
            {{width, height, std::vector<glm::vec3>(pixels, glm::vec3(1))}, layout, LatLongCenter::x});
        EXPECT_EQ(flat.pixels.size(), static_cast<std::size_t>(flat.width * flat.height));
        return std::pair(flat.width, flat.height);
    };
    // A face of a cube covers 90 degrees, the middle row of a probe 360.
    EXPECT_EQ(size(EnvironmentLayout::cube, 3, 18), std::pair(12, 6));
    EXPECT_EQ(size(EnvironmentLayout::cube_faces, 1, 6), std::pair(4, 2));
    EXPECT_EQ(size(EnvironmentLayout::angular, 10, 10), std::pair(10, 5));
    EXPECT_EQ(size(EnvironmentLayout::angular, 1, 1), std::pair(2, 1));
    EXPECT_EQ(size(EnvironmentLayout::lat_long, 7, 5), std::pair(7, 5));
}

class BadPixel : public testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(Kinds, BadPixel,
                         testing::Values(std::numeric_limits<float>::quiet_NaN(),
                                         std::numeric_limits<float>::infinity(),
                                         -std::numeric_limits<float>::infinity(), -0.5f));

TEST_P(BadPixel, IsAnErrorUnlessIgnored) {
    Image image{3, 1, {glm::vec3(1), glm::vec3(4, GetParam(), 2), glm::vec3(7)}};
    try {
        repair_pixels(image, BadPixels::error);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("x 1, y 0"), std::string::npos) << error.what();
    }
    Image zeroed = image, clamped = image;
    EXPECT_EQ(repair_pixels(zeroed, BadPixels::zero), 1u);
    EXPECT_EQ(zeroed.pixels[1], glm::vec3(0));
    EXPECT_EQ(repair_pixels(clamped, BadPixels::clamp), 1u);
    EXPECT_EQ(clamped.pixels[1], glm::vec3(4, GetParam() > 1e30f ? 7 : 0, 2));
    EXPECT_EQ(clamped.pixels[2], glm::vec3(7));
}

} // namespace
} // namespace prt
