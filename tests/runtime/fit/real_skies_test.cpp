// Tests suns of photographed skies with one sun each.

#include "prt/fit/suns.h"

#include "prt/image/image_file.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace prt {
namespace {

SunSplit split_of(const char* name) {
    return find_suns(load_environment(test::shared_file(name)).environment);
}

/// Two images of one location, with different layouts and texels.
TEST(RealSkies, AreOneSunInCubeAndLatLong) {
    if (test::shared_file("env/KernerEnvCube.exr").empty() ||
        test::shared_file("env/KernerEnvLatLong.exr").empty())
        GTEST_SKIP() << "no real files";
    const SunSplit cube = split_of("env/KernerEnvCube.exr"), flat = split_of("env/KernerEnvLatLong.exr");
    ASSERT_EQ(cube.suns.size(), 1u);
    ASSERT_EQ(flat.suns.size(), 1u);
    EXPECT_LT(glm::distance(cube.suns[0].towards, flat.suns[0].towards), 0.003f); // half a texel of the cube
    EXPECT_LT(flat.error_with, 0.3 * flat.error_without);
}

/// A sun above a road, at sunset, with more than half of the energy: it is where the brightest texel is, and
/// half a degree wide.
TEST(RealSkies, HaveTheirSunTakenOut) {
    const auto path = test::shared_file("env/pedestrian_overpass_1k.hdr");
    if (path.empty())
        GTEST_SKIP() << "no real files";
    const Environment sky = load_environment(path).environment;
    const auto& pixels = sky.image.pixels;
    const auto brightest =
        std::ranges::max_element(pixels, {}, [](const glm::vec3& p) { return p.r + p.g + p.b; }) -
        pixels.begin();
    const std::ptrdiff_t row = brightest / 1024, column = brightest % 1024;
    const glm::dvec3 there =
        lat_long_direction(1024, 512, static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    const SunSplit split = find_suns(sky);
    ASSERT_EQ(split.suns.size(), 1u);
    EXPECT_LT(glm::distance(glm::dvec3(split.suns[0].towards), there), 0.5 * std::numbers::pi / 512);
    EXPECT_NEAR(2 * split.suns[0].half_angle, 0.53 * std::numbers::pi / 180, 0.1 * std::numbers::pi / 180);
    EXPECT_GT(split.energy_shares[0], 0.5);
    EXPECT_LT(split.error_with, 0.1 * split.error_without);
}

} // namespace
} // namespace prt
