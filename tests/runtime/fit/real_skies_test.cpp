// Suns of photographed skies, whose pictures show one sun each.

#include "prt/suns.h"

#include "prt/image_file.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace prt {
namespace {

SunSplit split_of(const char* name) {
    return find_suns(load_environment(test::shared_file(name)).environment);
}

/// Two images of one place, of other layouts and other texels.
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

/// A sun above a road, at sunset, with more than half of the energy.
TEST(RealSkies, HaveTheirSunTakenOut) {
    if (test::shared_file("env/pedestrian_overpass_1k.hdr").empty())
        GTEST_SKIP() << "no real files";
    const SunSplit split = split_of("env/pedestrian_overpass_1k.hdr");
    ASSERT_EQ(split.suns.size(), 1u);
    // Where its highest texels are: column 656, row 248 of 1024 x 512.
    EXPECT_LT(glm::distance(glm::dvec3(split.suns[0].towards), lat_long_direction(1024, 512, 656, 248)),
              0.005);
    EXPECT_GT(split.suns[0].energy_share, 0.5);
    EXPECT_LT(split.error_with, 0.2 * split.error_without);
}

} // namespace
} // namespace prt
